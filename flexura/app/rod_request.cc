#include "flexura/app/rod_request.h"

#include <fmt/format.h>

#include "flexura/math/arrays.h"

namespace flexura {

TendonInput RodRequest::tendons() const {
  return {.tensions = tensions.value_or(std::vector<double>{}),
          .displacements = displacements.value_or(std::vector<double>{})};
}

RodLoads RodRequest::loads(const Rod& rod, RodLoads of_arm) const {
  if (gravity) of_arm.gravity = vector(*gravity);
  const EndLoad tip{
      .section = rod.sections.size() - 1, .force = vector(tip_force), .moment = vector(tip_moment)};
  if (!tip.force.isZero(0) || !tip.moment.isZero(0)) of_arm.ends.push_back(tip);
  return of_arm;
}

void check_rod_request(const Rod& rod, const RodRequest& request, Reader& reader) {
  const auto check_count = [&](const std::optional<std::vector<double>>& given, const char* name) {
    if (!given || given->size() == rod.tendons.size()) return;
    reader.problem_at(
        name, fmt::format("{} given: expected {} values, one per tendon", given->size(), rod.tendons.size()));
  };
  check_count(request.tensions, "tensions");
  check_count(request.displacements, "displacements");
  if (request.tensions && request.displacements)
    reader.problem_at("displacements",
                      "are given together with tensions: expected either displacements or tensions");
}

}  // namespace flexura
