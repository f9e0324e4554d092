#include "tools/program.h"

#include <algorithm>
#include <iostream>
#include <sstream>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

double numberOf(const std::string& text, const std::string& what) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = std::string::npos;
  }
  if (used != text.size()) throw InputError(what + ": '" + text + "' is not a number");
  requireFinite(value, what);
  return value;
}

}  // namespace

Arguments::Arguments(int argc, const char* const* argv, const std::string& usage,
                     std::size_t positional_count, const std::vector<std::string>& option_names) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      positional_.push_back(word);
      continue;
    }
    const std::string name = word.substr(2);
    if (std::find(option_names.begin(), option_names.end(), name) == option_names.end())
      throw InputError("unknown option " + word + "\nusage: " + usage);
    if (i + 1 == argc) throw InputError("option " + word + " needs a value\nusage: " + usage);
    options_[name] = argv[++i];
  }
  if (positional_.size() != positional_count)
    throw InputError("expected " + std::to_string(positional_count) + " arguments, got " +
                     std::to_string(positional_.size()) + "\nusage: " + usage);
}

std::string Arguments::text(const std::string& option, const std::string& otherwise) const {
  return has(option) ? options_.at(option).get<std::string>() : otherwise;
}

double Arguments::number(const std::string& option, double otherwise) const {
  return has(option) ? numberOf(text(option), "--" + option) : otherwise;
}

int Arguments::wholeNumber(const std::string& option, int otherwise) const {
  const double value = number(option, otherwise);
  if (value != static_cast<int>(value)) throw InputError("--" + option + " is not a whole number");
  return static_cast<int>(value);
}

std::vector<double> numbersOf(const std::string& text, std::size_t count, const std::string& what) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) numbers.push_back(numberOf(part, what));
  if (numbers.size() != count)
    throw InputError(what + ": expected " + std::to_string(count) + " numbers separated by commas, got '" +
                     text + "'");
  return numbers;
}

int runProgram(const std::string& name, const std::function<Outcome()>& body) {
  try {
    const Outcome outcome = body();
    std::cout << outcome.result.dump() << std::endl;
    return outcome.exit_code;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << std::endl;
    return kExitBadInput;
  }
}

}  // namespace cornerstone
