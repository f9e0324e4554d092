// Parameters from the parameter server into the stages' structs, with the refusals of base/params.h.
#pragma once

#include <ros/node_handle.h>

#include "cornerstone/base/params.h"

namespace cornerstone {

// All parameters under the node's private namespace; InputError when there are none.
YAML::Node loadParamTree(const ros::NodeHandle& private_node);

template <typename Params>
Params loadParams(const ros::NodeHandle& private_node) {
  return readParams<Params>(loadParamTree(private_node), private_node.getNamespace());
}

}  // namespace cornerstone
