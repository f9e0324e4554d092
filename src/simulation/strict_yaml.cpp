#include "strict_yaml.h"

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

template <typename T>
T scalarOf(const YAML::Node& node, const std::string& name, const char* type) {
  T value;
  if (!node.IsScalar() || !YAML::convert<T>::decode(node, value)) throw InputError(name + " is not " + type);
  return value;
}

}  // namespace

StrictMap::StrictMap(const YAML::Node& node, std::string where) : where_(std::move(where)) {
  node_.reset(node);
  if (!node_.IsMap()) throw InputError(where_ + ": expected a map");
}

StrictMap StrictMap::ofText(const std::string& text, const std::string& where) {
  try {
    return {YAML::Load(text), where};
  } catch (const YAML::Exception& error) {
    throw InputError(where + ": not YAML: " + error.what());
  }
}

bool StrictMap::has(const std::string& key) const {
  return static_cast<const YAML::Node&>(node_)[key].IsDefined();
}

YAML::Node StrictMap::required(const std::string& key) {
  read_keys_.insert(key);
  const YAML::Node value = static_cast<const YAML::Node&>(node_)[key];
  if (!value.IsDefined() || value.IsNull()) throw InputError(nameOf(key) + " is missing");
  return value;
}

double StrictMap::number(const std::string& key) {
  const auto value = scalarOf<double>(required(key), nameOf(key), "a number");
  requireFinite(value, nameOf(key));
  return value;
}

bool StrictMap::flag(const std::string& key) {
  return scalarOf<bool>(required(key), nameOf(key), "true or false");
}

std::string StrictMap::text(const std::string& key) {
  return scalarOf<std::string>(required(key), nameOf(key), "a text");
}

std::vector<double> StrictMap::rowOf(const YAML::Node& node, const std::string& name,
                                     std::size_t count) const {
  if (!node.IsSequence() || node.size() != count)
    throw InputError(name + " is not a list of " + std::to_string(count) + " numbers");
  std::vector<double> row;
  for (const auto& entry : node) {
    row.push_back(scalarOf<double>(entry, name, "a list of numbers"));
    requireFinite(row.back(), name);
  }
  return row;
}

std::vector<double> StrictMap::numbers(const std::string& key, std::size_t count) {
  return rowOf(required(key), nameOf(key), count);
}

std::vector<std::vector<double>> StrictMap::rows(const std::string& key, std::size_t columns) {
  const YAML::Node node = required(key);
  if (!node.IsSequence()) throw InputError(nameOf(key) + " is not a list");
  std::vector<std::vector<double>> rows;
  for (const auto& entry : node) rows.push_back(rowOf(entry, nameOf(key), columns));
  return rows;
}

StrictMap StrictMap::inner(const std::string& key) { return {required(key), where_ + "/" + key}; }

void StrictMap::each(const std::string& key, const std::function<void(StrictMap&)>& read) {
  const YAML::Node list = required(key);
  if (!list.IsSequence()) throw InputError(nameOf(key) + " is not a list");
  for (std::size_t i = 0; i < list.size(); ++i) {
    StrictMap map(list[i], where_ + "/" + key + "[" + std::to_string(i) + "]");
    read(map);
    map.requireAllRead();
  }
}

void StrictMap::requireAllRead() const {
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>();
    if (read_keys_.count(key) == 0) throw InputError(where_ + ": unknown key '" + key + "'");
  }
}

}  // namespace cornerstone
