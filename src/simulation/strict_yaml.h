// A YAML map whose keys are asked for by name: missing, mistyped and left-over keys are an InputError that
// names file, place and key. For files with lists of things (base/params.h reads plain structs).
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace cornerstone {

class StrictMap {
 public:
  StrictMap(const YAML::Node& node, std::string where);
  static StrictMap ofText(const std::string& text, const std::string& where);

  bool has(const std::string& key) const;
  std::string nameOf(const std::string& key) const {
    return key.empty() ? where_ : where_ + ": '" + key + "'";
  }
  double number(const std::string& key);  // finite
  bool flag(const std::string& key);
  std::string text(const std::string& key);
  std::vector<double> numbers(const std::string& key, std::size_t count);
  std::vector<std::vector<double>> rows(const std::string& key, std::size_t columns);
  StrictMap inner(const std::string& key);
  // Calls for every map of a list, and then holds it to have no unknown key.
  void each(const std::string& key, const std::function<void(StrictMap&)>& read);
  void requireAllRead() const;

 private:
  YAML::Node required(const std::string& key);
  std::vector<double> rowOf(const YAML::Node& node, const std::string& name, std::size_t count) const;

  YAML::Node node_;
  std::string where_;
  std::set<std::string> read_keys_;
};

}  // namespace cornerstone
