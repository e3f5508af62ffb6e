// Values of a recipe that have a default.
#pragma once
#include <yaml-cpp/yaml.h>

#include <string>

namespace ibrdf {

template <typename T>
T Get(const YAML::Node& node, const std::string& key, const T& otherwise) {
  return node[key] ? node[key].as<T>() : otherwise;
}

}  // namespace ibrdf
