#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexura/board/board_finder.h"
#include "flexura/board/intrinsics_fit.h"
#include "flexura/vision/picture_file.h"
#include "python/bindings/convert.h"
#include "python/bindings/module.h"
#include "python/bindings/picture.h"

namespace flexura::python {
namespace {

BoardTarget board_of(const std::string& pattern, int columns, int rows, double square) {
  if (columns < 3 || rows < 3 || columns > 1000 || rows > 1000)
    throw py::value_error("columns and rows: expected at least 3 and at most 1000");
  if (!(square > 0)) throw py::value_error("square: expected a number above 0");
  BoardTarget board{.columns = columns, .rows = rows, .square = square};
  const auto& names = names_of(&board.pattern);
  for (std::size_t i = 0; i < names.size(); ++i) {
    board.pattern = static_cast<BoardPattern>(i);
    if (names[i] == pattern) return board;
  }
  throw py::value_error(
      fmt::format("pattern: \"{}\": expected one of \"{}\"", pattern, fmt::join(names, "\", \"")));
}

py::array_t<double> pixels_array(const std::vector<Eigen::Vector2d>& pixels) {
  py::array_t<double> array(Sizes{static_cast<py::ssize_t>(pixels.size()), 2});
  double* to = array.mutable_data();
  for (const Eigen::Vector2d& pixel : pixels) {
    *to++ = pixel.x();
    *to++ = pixel.y();
  }
  return array;
}

py::tuple find(const py::array& array, const std::string& pattern, int columns, int rows) {
  const BoardTarget board = board_of(pattern, columns, rows, 1);
  const Picture given = picture_from(array);
  const auto* bytes = std::get_if<Image<std::uint8_t>>(&given);
  if (bytes == nullptr) throw py::type_error("picture: expected an array of uint8");
  BoardObservation found;
  {
    const py::gil_scoped_release released;
    found = find_board(gray_picture(*bytes), board);
  }
  return py::make_tuple(pixels_array(found.pixels), found.reason);
}

// The pixels of each camera in one view; None or no pixels where it did not see the board.
BoardView view_of(const py::sequence& cameras) {
  BoardView view;
  // An array makes its items when they are asked for.
  for (std::size_t k = 0; k < py::len(cameras); ++k) {
    const py::object camera = cameras[k];
    auto& pixels = view.pixels.emplace_back();
    if (camera.is_none()) continue;
    const auto array = py::cast<Reals>(camera);
    if (array.ndim() != 2 || array.shape(1) != 2)
      throw py::value_error("views: expected arrays of shape (points, 2), or None");
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
      pixels.push_back(Eigen::Map<const Eigen::Vector2d>(array.data(i, 0)));
  }
  return view;
}

py::dict camera_dict(const CameraFit& camera, const Pose& pose) {
  py::dict dict;
  dict["fx"] = camera.lens.fx;
  dict["fy"] = camera.lens.fy;
  dict["cx"] = camera.lens.cx;
  dict["cy"] = camera.lens.cy;
  const Distortion& distortion = camera.lens.distortion;
  dict["model"] = name_of(distortion.model());
  dict["distortion"] = std::vector<double>(distortion.begin(), distortion.end());
  const int size = camera.lens.size();
  dict["covariance"] = matrix_array(camera.covariance.topLeftCorner(size, size));
  dict["rms"] = camera.rms;
  dict["corner_sigma"] = camera.corner_sigma;
  dict["undetermined"] = camera.undetermined;
  dict["pose"] = pose_array(pose);
  return dict;
}

py::dict fit(const py::sequence& views, const std::vector<std::array<int, 2>>& sizes,
             const std::string& pattern, int columns, int rows, double square, std::optional<int> distortion,
             const std::string& model) {
  const BoardTarget board = board_of(pattern, columns, rows, square);
  std::vector<BoardView> given;
  for (std::size_t i = 0; i < py::len(views); ++i) {
    const py::object view = views[i];
    given.push_back(view_of(py::cast<py::sequence>(view)));
  }
  const std::vector<std::string>& models = names_of(static_cast<const LensModel*>(nullptr));
  const auto at = std::ranges::find(models, model);
  if (at == models.end()) throw py::value_error("model: expected \"brown\", \"rational\" or \"fisheye\"");
  const auto lens_model = static_cast<LensModel>(at - models.begin());
  IntrinsicsFit found;
  {
    const py::gil_scoped_release released;
    found = fit_intrinsics(board.points(), given, sizes,
                           {.model = lens_model, .distortion = distortion, .orders = board.equal_orders()});
  }
  py::dict result;
  result["found"] = found.is_found;
  result["reason"] = found.reason;
  if (!found.is_found) return result;
  py::list cameras, boards;
  for (std::size_t i = 0; i < found.cameras.size(); ++i)
    cameras.append(camera_dict(found.cameras[i], found.poses[i]));
  for (const auto& pose : found.boards)
    boards.append(pose ? py::object(pose_array(*pose)) : py::object(py::none()));
  result["cameras"] = cameras;
  result["boards"] = boards;
  result["rms"] = found.rms;
  result["noise"] = found.noise;
  return result;
}

}  // namespace

void bind_calibration(py::module_& module) {
  using py::arg;
  module.def(
      "find_board", &find, arg("picture"), arg("pattern") = "chessboard", arg("columns") = 9, arg("rows") = 6,
      "Finds a calibration board in a picture of uint8. pattern: \"chessboard\" (inner corners), "
      "\"circles\"\n"
      "or \"asymmetric-circles\". Returns its points (columns x rows, 2), px, row by row, and \"\"; or no\n"
      "points and the reason.");
  module.def(
      "fit_intrinsics", &fit, arg("views"), arg("sizes"), arg("pattern") = "chessboard", arg("columns") = 9,
      arg("rows") = 6, arg("square") = 0.025, py::kw_only(), arg("distortion") = py::none(),
      arg("model") = "brown",
      "Calibrates cameras that are fixed to each other. views: for each view a list with the points (n, 2),\n"
      "px, or None, of each camera. sizes: (width, height) of each camera, px. square: distance of the\n"
      "board's points, m. model: lens model, \"brown\", \"rational\" or \"fisheye\". distortion: number of\n"
      "fitted coefficients in the model's order; default: all. Returns a dict: found, reason, cameras (fx,\n"
      "fy, cx, cy, model, distortion, covariance in this order, rms, corner_sigma, px, undetermined, and "
      "the\n"
      "pose X_1C in the first camera), boards (poses X_1B or None), rms, noise, px.");
}

}  // namespace flexura::python
