#include "flexura/app/intrinsics_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/app/words.h"
#include "flexura/camera/distortion.h"

namespace flexura {
namespace {

const Node::Array& list_of(const Node& node, std::string_view key) {
  static const Node::Array none;
  const Node* list = node.find(key);
  return list == nullptr ? none : *list->as<Node::Array>();
}

std::string text_of(const Node& node, std::string_view key) {
  const Node* text = node.find(key);
  return text == nullptr ? "" : *text->as<std::string>();
}

// Returns a number and its standard deviation, of which two digits are shown.
std::string with_sigma(double value, double sigma) {
  if (!(sigma > 0) || !std::isfinite(sigma)) return fmt::format("{:.6g}", value);
  constexpr int most = 12;
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, most);
  return fmt::format("{0:.{2}f} +- {1:.{2}f}", value, sigma, decimals);
}

// Returns the value of one of a camera's numbers; "" if it was not estimated.
std::string number_of(const Node& camera, std::string_view key) {
  const Node* sigmas = camera.find("sigma");
  const Node* sigma = sigmas == nullptr ? nullptr : sigmas->find(key);
  if (sigma == nullptr) return "";
  if (const Node* value = camera.find(key)) return with_sigma(*value->as<double>(), *sigma->as<double>());
  const std::vector<std::string>& models = names_of(static_cast<const LensModel*>(nullptr));
  const auto model =
      static_cast<LensModel>(std::ranges::find(models, text_of(camera, "model")) - models.begin());
  const std::vector<std::string>& coefficients = coefficient_names(model);
  const auto index = static_cast<std::size_t>(std::ranges::find(coefficients, key) - coefficients.begin());
  const Node::Array& distortion = list_of(camera, "distortion");
  if (index >= distortion.size()) return "";
  return with_sigma(*distortion[index].as<double>(), *sigma->as<double>());
}

// Returns "camera left", or "zoom 2" of a lens at several zooms.
std::string heading_of(const Node& camera) {
  if (const Node* ratio = camera.find("ratio")) return fmt::format("zoom {:.4g}", *ratio->as<double>());
  if (camera.find("folder") != nullptr) return text_of(camera, "folder");
  return text_of(camera, "name");
}

std::string pictures_of(const Node& camera) {
  return fmt::format("{} of {}", *camera.find("views_used")->as<std::int64_t>(),
                     list_of(camera, "views").size());
}

std::string rms_of(const Node& camera) {
  const Node* rms = camera.find("rms_px");
  return rms == nullptr ? "" : fmt::format("{:.3g}", *rms->as<double>());
}

std::string unknown_of(const Node& camera) {
  std::vector<std::string> names;
  for (const Node& name : list_of(camera, "untold")) names.push_back(*name.as<std::string>());
  return fmt::format("{}", fmt::join(names, ", "));
}

// Returns what came of a compared lens model.
std::string result_of(const Node& model) {
  if (model.find("reason") != nullptr) return text_of(model, "reason");
  return fmt::format("rms {} px{}", rms_of(model),
                     *model.find("chosen")->as<bool>() ? ", explains the pictures best" : "");
}

class Lines {
 public:
  Lines(const Node::Array& cameras, std::ostream& out) : cameras_(cameras), out_(out) {}

  // Prints a line with the value of each camera, if there is one.
  template <class Value>
  void add(std::string_view name, const Value& value) {
    std::vector<std::string> cells;
    for (const Node& camera : cameras_) cells.push_back(one_line(value(camera)));
    if (std::ranges::all_of(cells, &std::string::empty)) return;
    std::string line = fmt::format("{:<16}", name);
    for (const std::string& cell : cells) line += fmt::format("{:<24}", cell);
    out_ << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  }

 private:
  const Node::Array& cameras_;
  std::ostream& out_;
};

void print_pictures_without(const Node::Array& cameras, std::ostream& out) {
  for (const Node& camera : cameras)
    for (const Node& view : list_of(camera, "views"))
      if (view.find("reason") != nullptr) print_line(out, text_of(view, "image"), text_of(view, "reason"));
}

}  // namespace

void print_intrinsics(const Node& answer, std::ostream& out) {
  const Node::Array& cameras = list_of(answer, answer.find("zoom") == nullptr ? "cameras" : "zoom");
  if (answer.find("reason") != nullptr) print_line(out, "not found", text_of(answer, "reason"));
  for (const Node& model : list_of(answer, "models"))
    print_line(out, "lens model " + text_of(model, "model"), result_of(model));
  Lines lines(cameras, out);
  lines.add("", heading_of);
  for (const char* key : {"fx", "fy", "cx", "cy"})
    lines.add(fmt::format("{} (px)", key), [key](const Node& camera) { return number_of(camera, key); });
  for (const char* key : {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"})
    lines.add(key, [key](const Node& camera) { return number_of(camera, key); });
  lines.add("rms (px)", rms_of);
  lines.add("pictures used", pictures_of);
  lines.add("not determined", unknown_of);
  if (const Node* pair = answer.find("pair"))
    out << fmt::format("the cameras are {:.4g} m apart; rms of the pair {} px\n",
                       *pair->find("distance")->as<double>(), rms_of(*pair));
  if (const Node* held_out = answer.find("held_out"))
    out << fmt::format("rms in {} pictures that were excluded from the fit: {} px\n",
                       *held_out->find("views")->as<std::int64_t>(), rms_of(*held_out));
  print_pictures_without(cameras, out);
  for (const char* key : {"file", "rig"})
    if (answer.find(key) != nullptr) print_line(out, key, text_of(answer, key));
  for (const Node& note : list_of(answer, "notes")) print_line(out, "note", *note.as<std::string>());
  for (const Node& camera : cameras)
    for (const Node& note : list_of(camera, "notes")) print_line(out, "note", *note.as<std::string>());
}

}  // namespace flexura
