// Parameters: one struct a stage, and beside it one function `void describe(ParamVisitor&, TheParams&)` that
// names every member once. Reading YAML, writing YAML and the test that holds shipped YAML against the
// structs all use it. Unknown, missing and mistyped keys are an InputError that names the key: a start never
// goes on with a guess.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>
#include <vector>

namespace cornerstone {

class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;
  virtual void field(const std::string& key, bool& value) = 0;
  virtual void field(const std::string& key, int& value) = 0;
  virtual void field(const std::string& key, double& value) = 0;
  virtual void field(const std::string& key, std::string& value) = 0;
  virtual void field(const std::string& key, std::vector<std::string>& value) = 0;
  // The key ends in _deg and holds degrees; the member holds radians.
  void degrees(const std::string& key, double& value_rad);
  // A nested map of parameters.
  virtual void group(const std::string& key, const std::function<void()>& members) = 0;
  // A list of maps of parameters; an item is described by its own describe().
  template <typename Item>
  void list(const std::string& key, std::vector<Item>& items) {
    const std::size_t count = itemCount(key, items.size());
    items.resize(count);
    for (std::size_t i = 0; i < count; ++i) item(key, i, [&] { describe(*this, items[i]); });
  }

 protected:
  virtual std::size_t itemCount(const std::string& key,
                                std::size_t count) = 0;  // of the struct to be filled or written
  virtual void item(const std::string& key, std::size_t index, const std::function<void()>& members) = 0;
};

// Reads a struct from a YAML map; `where` (a file, a namespace) starts every message.
class ParamReader : public ParamVisitor {
 public:
  ParamReader(const YAML::Node& node, std::string where);
  void field(const std::string& key, bool& value) override;
  void field(const std::string& key, int& value) override;
  void field(const std::string& key, double& value) override;
  void field(const std::string& key, std::string& value) override;
  void field(const std::string& key, std::vector<std::string>& value) override;
  void group(const std::string& key, const std::function<void()>& members) override;
  void requireAllRead() const;  // throws InputError with the first key that nobody asked for

 private:
  std::size_t itemCount(const std::string& key, std::size_t count) override;
  void item(const std::string& key, std::size_t index, const std::function<void()>& members) override;
  YAML::Node required(const std::string& key);
  void inside(const YAML::Node& inner, const std::string& name, const std::function<void()>& members);
  template <typename T>
  void readScalar(const std::string& key, const char* type, T& value);

  YAML::Node node_;
  std::string where_;
  std::vector<std::string> read_keys_;
};

// Writes a struct as a YAML map.
class ParamWriter : public ParamVisitor {
 public:
  void field(const std::string& key, bool& value) override { node_[key] = value; }
  void field(const std::string& key, int& value) override { node_[key] = value; }
  void field(const std::string& key, double& value) override { node_[key] = value; }
  void field(const std::string& key, std::string& value) override { node_[key] = value; }
  void field(const std::string& key, std::vector<std::string>& value) override { node_[key] = value; }
  void group(const std::string& key, const std::function<void()>& members) override;
  const YAML::Node& node() const { return node_; }

 private:
  std::size_t itemCount(const std::string& key, std::size_t count) override;
  void item(const std::string& key, std::size_t index, const std::function<void()>& members) override;
  YAML::Node written(const std::function<void()>& members);

  YAML::Node node_{YAML::NodeType::Map};
};

template <typename Params>
Params readParams(const YAML::Node& node, const std::string& where) {
  Params params;
  ParamReader reader(node, where);
  describe(reader, params);
  reader.requireAllRead();
  return params;
}

template <typename Params>
YAML::Node writeParams(Params params) {
  ParamWriter writer;
  describe(writer, params);
  return writer.node();
}

}  // namespace cornerstone
