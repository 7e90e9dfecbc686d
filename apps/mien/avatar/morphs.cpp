// Finds the morph targets of avatars.
#include "apps/mien/avatar/morphs.h"

#include <algorithm>

namespace mien::app {
namespace {

const Json kNone = Json::array();

std::size_t target_count(const Json& mesh) {
  return mesh.at("primitives").at(0).value("targets", kNone).size();
}

// Exporters store names in extras of the mesh or of its first primitive.
std::vector<std::string> target_names(const Json& mesh) {
  for (const Json* owner : {&mesh, &mesh.at("primitives").at(0)}) {
    const Json& extras = owner->value("extras", Json::object());
    if (extras.is_object() && extras.contains("targetNames")) {
      return extras.at("targetNames").get<std::vector<std::string>>();
    }
  }
  return {};
}

// Nodes with morph targets, not driven yet.
std::vector<MorphNode> morph_nodes(const Json& document) {
  std::vector<MorphNode> nodes;
  for (std::size_t i = 0; i < document.at("nodes").size(); ++i) {
    const Json& node = document.at("nodes").at(i);
    if (!node.contains("mesh")) {
      continue;
    }
    const Json& mesh = document.at("meshes").at(node.at("mesh").get<std::size_t>());
    if (const std::size_t count = target_count(mesh); count > 0) {
      MorphNode& morphs = nodes.emplace_back(MorphNode{i, std::vector<float>(count), {}});
      const Json& owner = node.contains("weights") ? node : mesh;
      const auto weights = owner.value("weights", std::vector<float>());
      std::copy_n(weights.begin(), std::min(count, weights.size()), morphs.rest.begin());
    }
  }
  return nodes;
}

const Json& mesh_of(const Json& document, const MorphNode& morphs) {
  return document.at("meshes").at(
      document.at("nodes").at(morphs.node).at("mesh").get<std::size_t>());
}

void drive_by_names(const Json& document, std::vector<MorphNode>& nodes) {
  std::vector<std::string> all;
  for (const MorphNode& morphs : nodes) {
    const std::vector<std::string> names = target_names(mesh_of(document, morphs));
    all.insert(all.end(), names.begin(), names.end());
  }
  const Drivers drivers = morph_drivers(all);
  for (MorphNode& morphs : nodes) {
    const std::vector<std::string> names = target_names(mesh_of(document, morphs));
    for (std::size_t i = 0; i < std::min(names.size(), morphs.rest.size()); ++i) {
      if (const auto known = drivers.find(names[i]); known != drivers.end()) {
        morphs.terms.push_back({i, known->second, 1.0});
      }
    }
  }
}

// A morph target that an expression of a VRM moves.
struct Bind {
  std::string expression;
  const char* owner;  // what `index` refers to: node or mesh
  std::size_t index, target;
  double weight;  // 0..1
};

// VRM 0.x: groups with a preset or a name of their own, weights in percent, of meshes.
std::vector<Bind> binds_0(const Json& vrm) {
  std::vector<Bind> binds;
  for (const Json& group : vrm.at("blendShapeMaster").at("blendShapeGroups")) {
    const std::string preset = group.value("presetName", "unknown");
    const std::string name = preset == "unknown" ? group.value("name", "") : preset;
    for (const Json& bind : group.value("binds", kNone)) {
      binds.push_back({name, "mesh", bind.at("mesh").get<std::size_t>(),
                       bind.at("index").get<std::size_t>(), bind.at("weight").get<double>() / 100});
    }
  }
  return binds;
}

// VRM 1.0: presets and custom expressions, of nodes.
std::vector<Bind> binds_1(const Json& vrm) {
  std::vector<Bind> binds;
  const Json expressions = vrm.value("expressions", Json::object());
  for (const char* kind : {"preset", "custom"}) {
    const Json listed = expressions.value(kind, Json::object());
    for (const auto& [name, expression] : listed.items()) {
      for (const Json& bind : expression.value("morphTargetBinds", kNone)) {
        binds.push_back({name, "node", bind.at("node").get<std::size_t>(),
                         bind.at("index").get<std::size_t>(), bind.at("weight").get<double>()});
      }
    }
  }
  return binds;
}

void drive_by_expressions(const Json& document, const std::vector<Bind>& binds,
                          std::vector<MorphNode>& nodes) {
  std::vector<std::string> names;
  names.reserve(binds.size());
  for (const Bind& bind : binds) {
    names.push_back(bind.expression);
  }
  const Drivers drivers = expression_drivers(names);
  for (const Bind& bind : binds) {
    const auto driver = drivers.find(bind.expression);
    for (MorphNode& morphs : nodes) {
      const bool same = std::string_view(bind.owner) == "node"
                            ? bind.index == morphs.node
                            : bind.index == document.at("nodes").at(morphs.node).at("mesh");
      if (same && driver != drivers.end() && bind.target < morphs.rest.size()) {
        morphs.terms.push_back({bind.target, driver->second, bind.weight});
      }
    }
  }
}

}  // namespace

std::vector<MorphNode> find_morphs(const Json& document) {
  std::vector<MorphNode> nodes = morph_nodes(document);
  if (const Json* vrm = vrm_1(document)) {
    drive_by_expressions(document, binds_1(*vrm), nodes);
  } else if (const Json* old = vrm_0(document)) {
    drive_by_expressions(document, binds_0(*old), nodes);
  } else {
    drive_by_names(document, nodes);
  }
  std::erase_if(nodes, [](const MorphNode& morphs) { return morphs.terms.empty(); });
  return nodes;
}

}  // namespace mien::app
