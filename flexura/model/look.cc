#include "flexura/model/look.h"

#include <fmt/format.h>

#include <algorithm>

#include "flexura/base/table.h"
#include "flexura/model/ranges.h"

namespace flexura {
namespace {

// Largest number of markers in a picture.
constexpr std::size_t max_marks = 4096;

Spec color_of(const char* what) {
  return {.meaning = fmt::format("Fractions of red, green and blue light that {}.", what),
          .range = share_range};
}

Spec place_of(const char* what) {
  return {
      .meaning = fmt::format("Distance of the middle of {} from the base, along the unstretched arm.", what),
      .unit = Unit::metre,
      .range = between(0, 1e6),
      .required = true};
}

Spec size_of(const char* meaning) {
  return {.meaning = meaning, .unit = Unit::metre, .range = above_up_to(0, 1e6)};
}

}  // namespace

const std::vector<std::string>& names_of(const TipKind*) {
  static const std::vector<std::string> names = {"flat", "round"};
  return names;
}

const Table<Marker>& fields_of(const Marker*) {
  static const auto table = Table<Marker>("marker", "A coloured band around the arm.")
                                .field("at", &Marker::at, place_of("the band"))
                                .field("width", &Marker::width, size_of("Width of the band along the arm."))
                                .field("color", &Marker::color, color_of("the band reflects"));
  return table;
}

const Table<MarkerBands>& fields_of(const MarkerBands*) {
  static const auto table =
      Table<MarkerBands>("bands", "Coloured bands at equal distances along every section.")
          .field("per_section", &MarkerBands::per_section,
                 {.meaning = "Bands per section. The last band ends at the section's end.",
                  .range = between(1, 1000)})
          .field("width", &MarkerBands::width,
                 {.meaning = "Width of a band along the arm.",
                  .unit = Unit::metre,
                  .range = above_up_to(0, 1e6),
                  .default_text = "a fifth of the band spacing"})
          .field("colors", &MarkerBands::colors,
                 {.meaning = "Colours of the bands from base to tip, repeated cyclically: reflected "
                             "fractions of red, green and blue light.",
                  .range = share_range,
                  .count = {1, 1000}});
  return table;
}

const Table<Disk>& fields_of(const Disk*) {
  static const auto table = Table<Disk>("disk", "A flat, round guide disk across the arm.")
                                .field("at", &Disk::at, place_of("the disk"))
                                .field("radius", &Disk::radius, size_of("Radius of the disk."))
                                .field("thickness", &Disk::thickness, size_of("Thickness of the disk."));
  return table;
}

const Table<LookConfig>& fields_of(const LookConfig*) {
  static const auto table = Table<LookConfig>("look", "Appearance of the arm in pictures.")
                                .field("color", &LookConfig::color, color_of("the arm reflects"))
                                .field("tip", &LookConfig::tip,
                                       {.meaning = "Shape of the tip: cut straight across, or a hemisphere."})
                                .field("bands", &LookConfig::bands,
                                       {.meaning = "Coloured bands at equal distances along every section.",
                                        .default_text = "none"})
                                .field("marker", &LookConfig::marker,
                                       {.meaning = "Single coloured bands, as tables [[arm.look.marker]].",
                                        .count = {0, max_marks},
                                        .default_text = "none"})
                                .field("disk", &LookConfig::disk,
                                       {.meaning = "Guide disks, as tables [[arm.look.disk]].",
                                        .count = {0, max_marks},
                                        .default_text = "none"})
                                .field("disk_color", &LookConfig::disk_color, color_of("the disks reflect"));
  return table;
}

std::vector<Marker> LookConfig::markers(const Arm& arm) const {
  std::vector<Marker> all = marker;
  double base = 0;
  std::size_t count = 0;
  for (const Section& section : arm.sections) {
    if (bands) {
      const double distance = section.length / static_cast<double>(bands->per_section);
      const double width = bands->width.value_or(distance / 5);
      for (std::int64_t i = 1; i <= bands->per_section; ++i)
        all.push_back({base + static_cast<double>(i) * distance - width / 2, width,
                       bands->colors[count++ % bands->colors.size()]});
    }
    base += section.length;
  }
  std::ranges::stable_sort(all, {}, &Marker::at);
  return all;
}

void check_look(const LookConfig& look, const Arm& arm, const std::string& path, Reader& reader) {
  const double length = arm.length();
  // Tolerance for rounding errors in sums of section lengths.
  const double slack = 1e-9 * length;
  const auto off_arm = [&](double at, double width) {
    return at - width / 2 < -slack || at + width / 2 > length + slack;
  };
  const auto report = [&](const char* list, std::size_t index) {
    reader.problem_at(fmt::format("{}.{}[{}]", path, list, index),
                      fmt::format("is not on the arm: expected 0 to {:.6g} m", length));
  };
  bool all_on_arm = true;
  for (std::size_t i = 0; i < look.marker.size(); ++i)
    if (off_arm(look.marker[i].at, look.marker[i].width)) report("marker", i), all_on_arm = false;
  for (std::size_t i = 0; i < look.disk.size(); ++i)
    if (off_arm(look.disk[i].at, look.disk[i].thickness)) report("disk", i), all_on_arm = false;
  if (!all_on_arm) return;
  const std::vector<Marker> markers = look.markers(arm);
  if (markers.size() > max_marks) {
    reader.problem_at(path,
                      fmt::format("results in {} bands: expected at most {}", markers.size(), max_marks));
    return;
  }
  for (std::size_t i = 0; i + 1 < markers.size(); ++i) {
    if (markers[i].at + markers[i].width / 2 <= markers[i + 1].at - markers[i + 1].width / 2 + slack)
      continue;
    reader.problem_at(
        path,
        fmt::format("has markers at {:.6g} m and {:.6g} m that overlap: expected markers that do not overlap",
                    markers[i].at, markers[i + 1].at));
    return;
  }
}

}  // namespace flexura
