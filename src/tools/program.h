// What every command-line program shares: the last line of its output is one JSON object; exit 0 done, 2 bad
// arguments or input, 3 no answer.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cornerstone {

constexpr int kExitDone = 0;
constexpr int kExitBadInput = 2;
constexpr int kExitNoAnswer = 3;

// Command-line arguments: positional ones in order, and --name VALUE. InputError on anything unknown or
// missing.
class Arguments {
 public:
  Arguments(int argc, const char* const* argv, const std::string& usage, std::size_t positional_count,
            const std::vector<std::string>& option_names);
  const std::string& positional(std::size_t index) const { return positional_.at(index); }
  bool has(const std::string& option) const { return options_.contains(option); }
  std::string text(const std::string& option, const std::string& otherwise = "") const;
  double number(const std::string& option, double otherwise) const;
  int wholeNumber(const std::string& option, int otherwise) const;

 private:
  std::vector<std::string> positional_;
  nlohmann::json options_ = nlohmann::json::object();
};

// "1,2.5,-90" -> {1, 2.5, -90}; InputError naming `what` otherwise.
std::vector<double> numbersOf(const std::string& text, std::size_t count, const std::string& what);

// Runs the program's body: prints an InputError to stderr and returns 2; prints what the body returns
// otherwise.
struct Outcome {
  int exit_code = kExitDone;
  nlohmann::json result;
};
int runProgram(const std::string& name, const std::function<Outcome()>& body);

}  // namespace cornerstone
