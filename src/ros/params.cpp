#include "cornerstone/ros/params.h"

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(toYaml(value[i]));
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& member : value) map[member.first] = toYaml(member.second);
      return map;
    }
    default:
      return {};
  }
}

}  // namespace

YAML::Node loadParamTree(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue tree;
  if (!private_node.getParam(private_node.getNamespace(), tree) ||
      tree.getType() != XmlRpc::XmlRpcValue::TypeStruct)
    throw InputError(private_node.getNamespace() +
                     ": no parameters; load the file of config/ that belongs here");
  return toYaml(tree);
}

}  // namespace cornerstone
