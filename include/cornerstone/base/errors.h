// The one exception for bad input: files, configuration, calibration, arguments. Its text names the file,
// field or topic. Programs turn it into exit code 2, nodelets into a refused start. A programmer's fault
// throws std::logic_error; "no answer" is an empty optional, never an exception.
#pragma once

#include <stdexcept>
#include <string>

namespace cornerstone {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// `name` is what a user would look for: a YAML key, a topic, a file and field.
void requireFinite(double value, const std::string& name);    // throws InputError
void requirePositive(double value, const std::string& name);  // finite and > 0, else InputError
void requireWithin(double value, double low, double high, const std::string& name);

}  // namespace cornerstone
