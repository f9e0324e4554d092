#include "cornerstone/base/params.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {

void ParamVisitor::degrees(const std::string& key, double& value_rad) {
  double value_deg = value_rad * 180 / M_PI;
  field(key, value_deg);
  value_rad = value_deg * M_PI / 180;
}

ParamReader::ParamReader(const YAML::Node& node, std::string where) : where_(std::move(where)) {
  node_.reset(node);
  if (!node_.IsMap()) throw InputError(where_ + ": expected a map of parameters");
}

YAML::Node ParamReader::required(const std::string& key) {
  read_keys_.push_back(key);
  const YAML::Node value = static_cast<const YAML::Node&>(node_)[key];
  if (!value.IsDefined() || value.IsNull()) throw InputError(where_ + ": parameter '" + key + "' is missing");
  return value;
}

template <typename T>
void ParamReader::readScalar(const std::string& key, const char* type, T& value) {
  const YAML::Node node = required(key);
  if (!node.IsScalar() || !YAML::convert<T>::decode(node, value))
    throw InputError(where_ + ": parameter '" + key + "' is not " + type);
}

void ParamReader::field(const std::string& key, bool& value) { readScalar(key, "true or false", value); }
void ParamReader::field(const std::string& key, int& value) { readScalar(key, "a whole number", value); }
void ParamReader::field(const std::string& key, double& value) {
  readScalar(key, "a number", value);
  requireFinite(value, where_ + ": parameter '" + key + "'");
}
void ParamReader::field(const std::string& key, std::string& value) { readScalar(key, "a text", value); }
void ParamReader::field(const std::string& key, std::vector<std::string>& value) {
  const YAML::Node node = required(key);
  if (!node.IsSequence() || !YAML::convert<std::vector<std::string>>::decode(node, value))
    throw InputError(where_ + ": parameter '" + key + "' is not a list of texts");
}

void ParamReader::group(const std::string& key, const std::function<void()>& members) {
  const YAML::Node inner = required(key);
  if (!inner.IsMap()) throw InputError(where_ + ": parameter '" + key + "' is not a map");
  inside(inner, key, members);
}

std::size_t ParamReader::itemCount(const std::string& key, std::size_t) {
  const YAML::Node list = required(key);
  if (!list.IsSequence()) throw InputError(where_ + ": parameter '" + key + "' is not a list");
  return list.size();
}

void ParamReader::item(const std::string& key, std::size_t index, const std::function<void()>& members) {
  const YAML::Node inner = required(key)[index];
  const std::string name = key + "[" + std::to_string(index) + "]";
  if (!inner.IsMap()) throw InputError(where_ + ": parameter '" + name + "' is not a map");
  inside(inner, name, members);
}

void ParamReader::inside(const YAML::Node& inner, const std::string& name,
                         const std::function<void()>& members) {
  const YAML::Node outer_node = node_;
  const std::string outer_where = where_;
  const std::vector<std::string> outer_keys = read_keys_;
  node_.reset(inner);
  where_ += "/" + name;
  read_keys_.clear();
  members();
  requireAllRead();
  node_.reset(outer_node);
  where_ = outer_where;
  read_keys_ = outer_keys;
}

void ParamReader::requireAllRead() const {
  for (const auto& entry : node_) {
    const auto key = entry.first.as<std::string>();
    if (std::find(read_keys_.begin(), read_keys_.end(), key) == read_keys_.end())
      throw InputError(where_ + ": unknown parameter '" + key + "'");
  }
}

YAML::Node ParamWriter::written(const std::function<void()>& members) {
  const YAML::Node outer = node_;
  node_.reset(YAML::Node(YAML::NodeType::Map));
  members();
  const YAML::Node inner = node_;
  node_.reset(outer);
  return inner;
}

void ParamWriter::group(const std::string& key, const std::function<void()>& members) {
  node_[key] = written(members);
}

std::size_t ParamWriter::itemCount(const std::string& key, std::size_t count) {
  node_[key] = YAML::Node(YAML::NodeType::Sequence);
  return count;
}

void ParamWriter::item(const std::string& key, std::size_t, const std::function<void()>& members) {
  node_[key].push_back(written(members));
}

}  // namespace cornerstone
