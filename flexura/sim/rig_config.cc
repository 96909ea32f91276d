#include "flexura/sim/rig_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "flexura/base/reader.h"
#include "flexura/base/source.h"
#include "flexura/base/unit.h"

namespace flexura {
namespace {

void lay(Node& under, Node over, std::string_view path);

const std::string* name_of(const Node& entry) {
  const Node* name = entry.find("name");
  return name == nullptr ? nullptr : name->as<std::string>();
}

bool holds_tables(const Node::Array& entries) {
  return !entries.empty() &&
         std::ranges::all_of(entries, [](const Node& entry) { return entry.as<Node::Table>() != nullptr; });
}

void lay_by_name(Node::Array& below, Node entry, const std::string& path) {
  const std::string name = *name_of(entry);
  const SourcePosition where = entry.find("name")->where;
  const auto found = std::ranges::find_if(below, [&](const Node& candidate) {
    const std::string* other = name_of(candidate);
    return other != nullptr && *other == name;
  });
  if (found == below.end()) {
    throw InputError(std::vector<Problem>{
        {where,
         fmt::format(
             "truth.{}: no entry outside [truth] has the name \"{}\": expected the name of an existing entry",
             path, name)}});
  }
  lay(*found, std::move(entry), path);
}

// Merges the arrays entry by entry if possible; returns whether it did.
bool lay_entries(Node& under, Node& over, const std::string& path) {
  auto* below = under.as<Node::Array>();
  auto* above = over.as<Node::Array>();
  if (below == nullptr || above == nullptr || !holds_tables(*below) || !holds_tables(*above)) return false;
  const bool named = std::ranges::all_of(*above, [](const Node& entry) { return name_of(entry) != nullptr; });
  if (!named && below->size() != above->size()) return false;
  std::set<std::string> names;
  for (std::size_t i = 0; i < above->size(); ++i) {
    if (named) {
      const std::string& name = *name_of((*above)[i]);
      if (!names.insert(name).second) {
        throw InputError(
            std::vector<Problem>{{(*above)[i].where, fmt::format("truth.{}[{}].name: \"{}\" is the name of "
                                                                 "another entry",
                                                                 path, i, name)}});
      }
      lay_by_name(*below, std::move((*above)[i]), path);
    } else {
      lay((*below)[i], std::move((*above)[i]), path);
    }
  }
  return true;
}

// Returns whether two keys are alternative descriptions of the same thing. Examples are the rotation of a
// mount (camera/mount.h), and the stiffness and weight of a rod (model/material.h). The upper document
// chooses the alternative.
bool is_other_way(std::string_view above, std::string_view below) {
  constexpr std::pair<std::string_view, std::string_view> ways[] = {
      {"look_at", "rotation"},         {"rotation", "look_at"},        {"rotation", "roll"},
      {"stiffness", "youngs_modulus"}, {"stiffness", "shear_modulus"}, {"stiffness", "poisson"},
      {"youngs_modulus", "stiffness"}, {"shear_modulus", "stiffness"}, {"shear_modulus", "poisson"},
      {"poisson", "stiffness"},        {"poisson", "shear_modulus"},   {"density", "mass_per_length"},
      {"mass_per_length", "density"}};
  return std::ranges::find(ways, std::pair{above, below}) != std::end(ways);
}

void drop_other_ways(Node::Table& below, std::string_view key) {
  std::erase_if(below, [&](const Node::Member& member) {
    return is_other_way(without_unit(key), without_unit(member.key));
  });
}

void lay(Node& under, Node over, std::string_view path) {
  auto* below = under.as<Node::Table>();
  auto* above = over.as<Node::Table>();
  if (below == nullptr || above == nullptr) {
    if (!lay_entries(under, over, std::string(path))) under = std::move(over);
    return;
  }
  for (const Node::Member& member : *above) drop_other_ways(*below, member.key);
  for (Node::Member& member : *above) {
    const auto same = std::ranges::find_if(*below, [&](const Node::Member& candidate) {
      return without_unit(candidate.key) == without_unit(member.key);
    });
    if (same == below->end()) {
      below->push_back(std::move(member));
    } else if (same->key == member.key) {
      lay(same->node, std::move(member.node),
          fmt::format("{}{}{}", path, path.empty() ? "" : ".", member.key));
    } else {
      *same = std::move(member);
    }
  }
}

}  // namespace

Node truth_of(Node document) {
  auto* members = document.as<Node::Table>();
  if (members == nullptr) return document;
  const auto found = std::ranges::find(*members, "truth", &Node::Member::key);
  if (found == members->end()) return document;
  Node truth = std::move(found->node);
  members->erase(found);
  if (truth.as<Node::Table>() == nullptr) {
    throw InputError(
        std::vector<Problem>{{truth.where, fmt::format("truth = {}: expected a table", truth.brief())}});
  }
  lay(document, std::move(truth), "");
  return document;
}

std::string truth_problem(const RigConfig& model, const RigConfig& truth) {
  if (truth.arm.kind != model.arm.kind) return "the true arm and the model's arm have different kinds";
  if (truth.arm.section.size() != model.arm.section.size()) {
    return fmt::format("the true arm has {} sections: expected {}, as in the model", truth.arm.section.size(),
                       model.arm.section.size());
  }
  if (truth.drive.has_value() != model.drive.has_value())
    return "expected a drive in the truth and in the model, or in neither";
  if (truth.drive && truth.drive->tendon.size() != model.drive->tendon.size()) {
    return fmt::format("the true drive has {} tendons: expected {}, as in the model",
                       truth.drive->tendon.size(), model.drive->tendon.size());
  }
  if (truth.arm.mechanics != ArmMechanics::kinematic && truth.drive && !truth.arm.tendon.empty() &&
      truth.arm.tendon.size() != truth.drive->tendon.size())
    return fmt::format("the true arm has {} tendons: expected {}, one per tendon of the drive",
                       truth.arm.tendon.size(), truth.drive->tendon.size());
  if (!std::ranges::equal(truth.cameras, model.cameras, {}, &CameraConfig::name, &CameraConfig::name))
    return "expected equal camera names in the truth and in the model, in equal order";
  for (std::size_t i = 0; i < model.cameras.size(); ++i) {
    const SensorConfig &one = truth.cameras[i].sensor, &other = model.cameras[i].sensor;
    if (one.width != other.width || one.height != other.height || one.bits != other.bits ||
        one.pixels != other.pixels)
      return fmt::format(
          "the images of the true camera {} differ in size or kind from the images of the model's camera",
          model.cameras[i].name);
  }
  return "";
}

}  // namespace flexura
