#include <iostream>
#include <memory>
#include <string>

#include "flexura/app/board.h"
#include "flexura/app/command_line.h"
#include "flexura/app/estimate.h"
#include "flexura/app/intrinsics.h"
#include "flexura/app/measure.h"
#include "flexura/app/render.h"
#include "flexura/app/terminal_progress.h"

namespace flexura {
namespace {

void add_render(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* render = add_command(app, "render", command_group::pictures,
                                 "Render the picture of one of an experiment's cameras",
                                 "flexura render experiment.toml --camera front --time 1.5 --out front.png");
  render->add_option("EXPERIMENT", arguments->experiment, "The experiment file (TOML)")
      ->type_name("")
      ->required();
  render->add_option("--camera", arguments->camera, "The camera's name")->type_name("NAME")->required();
  render->add_option("--time", arguments->time, "Time in the experiment, s, from 0 (default: 0)")
      ->type_name("T");
  render->add_option("--out", arguments->out, "The image file to write (.png)")
      ->type_name("FILE")
      ->required();
  render->add_flag("--model", arguments->model, "Draw the nominal rig: ignore [truth]");
  render->add_flag("--truth", arguments->truth,
                   "Also write exact depth, labels and curves from the geometry");
  add_set_option(*render, arguments->sets);
  render->callback(
      [&chosen, arguments] { chosen = [arguments] { return render_command(*arguments, std::cout); }; });
}

void add_threshold_options(CLI::App& command, ThresholdArguments& threshold) {
  command
      .add_option("--threshold", threshold.method,
                  "How to separate the arm from the background (default: otsu)")
      ->type_name("otsu|two_mode|by_block|fixed");
  command.add_option("--level", threshold.level, "The fixed threshold, 0 to 255")->type_name("LEVEL");
  command
      .add_option("--figure", threshold.figure,
                  "Whether the arm is dark or bright (default: the opposite of the picture's border)")
      ->type_name("dark|bright");
}

void add_scene_options(CLI::App& command, SceneArguments& scene) {
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* type,
                       const char* text) {
    command.add_option(name, values, text)->type_name(type)->allow_extra_args(false);
  };
  add("--region", scene.regions, "U,V,...",
      "Search only here: two corners of a rectangle, or three or more of a polygon, px; once, or per "
      "picture");
  add("--background", scene.backgrounds, "FILE",
      "Picture of the same view without the arm: search only what differs; once, or per picture");
  command.add_option("--color", scene.color, "Colour of the arm, 0 to 255: search only what has this colour")
      ->type_name("R,G,B");
  add("--mask", scene.masks, "FILE", "Mask of the arm, made elsewhere: white on black; once, or per picture");
}

void add_measure(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<MeasureArguments>();
  CLI::App* measure =
      add_command(app, "measure", command_group::pictures,
                  "Find the arm, its markers, a circle or the calibration cylinder in pictures",
                  "flexura measure front.png --what markers --overlay found.png");
  measure
      ->add_option("IMAGE", arguments->images,
                   "Pictures: PNG, JPEG, TIFF or PNM, up to 16 bits, gray or colour")
      ->required();
  measure->add_option("--what", arguments->what, "What to find (default: arm)")
      ->type_name("arm|etalon|circle|markers");
  measure
      ->add_option("--camera", arguments->camera,
                   "File of calibrated cameras (TOML): one camera for all pictures, or one per picture")
      ->type_name("FILE");
  measure->add_option("--radius", arguments->radius, "Radius of the arm, m; needed to estimate depths")
      ->type_name("R");
  measure
      ->add_option("--gamma", arguments->gamma,
                   "Gamma of the pictures: value = light^(1/G); 2.2 for most cameras' files")
      ->type_name("G");
  add_threshold_options(*measure, arguments->threshold);
  add_scene_options(*measure, arguments->scene);
  measure->add_option("--base", arguments->base, "Pixel near the base of the arm: U,V")
      ->type_name("U,V")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(2);
  measure
      ->add_option("--overlay", arguments->overlay, "Write the picture with the results drawn over it (.png)")
      ->type_name("FILE");
  measure->callback(
      [&chosen, arguments] { chosen = [arguments] { return measure_command(*arguments, std::cout); }; });
}

void add_estimate(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<EstimateArguments>();
  CLI::App* estimate =
      add_command(app, "estimate", command_group::pictures,
                  "Estimate the arm's shape from pictures of two or more cameras",
                  "flexura estimate front.png side.png --cameras cameras.toml --arm arm.toml");
  estimate->add_option("IMAGE", arguments->images, "Picture files, one from each camera")
      ->type_name("")
      ->required();
  estimate
      ->add_option("--cameras", arguments->cameras,
                   "File of calibrated cameras (TOML), in the order of the pictures")
      ->type_name("FILE")
      ->required();
  estimate->add_option("--base", arguments->base, "Position of the base of the arm, m: X,Y,Z")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3);
  estimate->add_option("--length", arguments->length, "Length of the arm, m")->type_name("L");
  estimate->add_option("--arm", arguments->arm, "File with the sections of the arm, if they are known (TOML)")
      ->type_name("FILE");
  estimate
      ->add_option("--markers", arguments->markers,
                   "Arc lengths of the arm's bands, m, or percent of its length: 25%")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("S,...");
  add_threshold_options(*estimate, arguments->threshold);
  add_scene_options(*estimate, arguments->scene);
  estimate
      ->add_option("--guess", arguments->guess,
                   "JSON file with guessed bends, such as an earlier answer: fit the arm near this shape")
      ->type_name("FILE");
  estimate
      ->add_option("--guess-std", arguments->guess_std,
                   "Standard deviation of each guessed bend, rad (default: 0.1)")
      ->type_name("RAD");
  estimate
      ->add_option("--points", arguments->points,
                   "Number of points of the printed backbone, at least 2 (default: 101)")
      ->type_name("N");
  estimate->callback([&chosen, arguments] {
    chosen = [arguments] {
      TerminalProgress progress(std::cerr);
      return estimate_command(*arguments, std::cout, &progress);
    };
  });
}

void add_board_options(CLI::App& command, BoardArguments& board) {
  command.add_option("--board", board.board, "Number of inner corners, circles or AprilTags: COLUMNSxROWS")
      ->type_name("CxR")
      ->required();
  command
      .add_option("--square", board.square,
                  "Side of a square, or distance between rows of circles or AprilTags, m")
      ->type_name("S")
      ->required();
  command.add_option("--pattern", board.pattern, "Pattern of the board (default: chessboard)")
      ->type_name("chessboard|circles|asymmetric-circles|charuco|apriltags");
  command
      .add_option("--marker", board.marker,
                  "Side of the markers of charuco or apriltags, with their border, m")
      ->type_name("M");
  command.add_option("--family", board.family, "Family of the markers (default: 4x4; apriltags: 36h11)")
      ->type_name("4x4|5x5|6x6|36h11");
}

void add_board(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<DrawBoardArguments>();
  CLI::App* board = add_command(app, "board", command_group::pictures, "Draw a calibration board to print",
                                "flexura board --board 8x5 --square 0.028 --pattern charuco --marker 0.02 "
                                "--paper a4 --out board.pdf");
  add_board_options(*board, *arguments);
  board
      ->add_option("--paper", arguments->paper, "Size of the sheet (default: fit, the board with its border)")
      ->type_name("a4|a3|letter|fit");
  board->add_option("--out", arguments->out, "The file to write (.pdf or .svg)")
      ->type_name("FILE")
      ->required();
  board->callback(
      [&chosen, arguments] { chosen = [arguments] { return board_command(*arguments, std::cout); }; });
}

void add_intrinsics(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<IntrinsicsArguments>();
  CLI::App* intrinsics =
      add_command(app, "intrinsics", command_group::pictures, "Calibrate cameras from pictures of a board",
                  "flexura intrinsics left*.jpg --board 9x6 --square 0.025 --out cameras.toml");
  intrinsics->add_option("IMAGE", arguments->images, "Pictures of the board from one camera")->type_name("");
  intrinsics->add_option("--left", arguments->left, "Pictures from the first camera of a pair")
      ->type_name("IMAGE");
  intrinsics
      ->add_option("--right", arguments->right, "Pictures from the second camera, taken at the same times")
      ->type_name("IMAGE");
  intrinsics
      ->add_option("--zoom", arguments->zooms,
                   "A folder of pictures at one zoom: RATIO=, RATIO@COUNT= or @COUNT=FOLDER (repeatable)")
      ->type_name("ZOOM=FOLDER")
      ->allow_extra_args(false);
  add_board_options(*intrinsics, *arguments);
  intrinsics
      ->add_option("--lens", arguments->lens,
                   "Lens model, or best: compare all models and use the best one (default: brown)")
      ->type_name("brown|rational|fisheye|best");
  intrinsics
      ->add_option("--distortion", arguments->distortion,
                   "Number of the model's distortion coefficients to estimate (default: all)")
      ->type_name("N");
  intrinsics
      ->add_option("--hold-out", arguments->hold_out,
                   "Exclude every Nth view from the fit, and test the fit with the excluded views")
      ->type_name("N");
  intrinsics->add_option("--name", arguments->names, "The camera's name; twice for a pair")
      ->type_name("NAME")
      ->allow_extra_args(false);
  intrinsics
      ->add_option("--position", arguments->position, "Position of the first camera in the world, m: X,Y,Z")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3);
  intrinsics
      ->add_option("--rotation", arguments->rotation,
                   "Rotation of the first camera in the world, a quaternion: W,X,Y,Z")
      ->type_name("W,X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(4);
  intrinsics->add_option("--out", arguments->out, "Write the calibrated cameras into a file (.toml)")
      ->type_name("FILE");
  intrinsics
      ->add_option("--rig", arguments->rig, "Write a file of cameras that experiments can include (.toml)")
      ->type_name("FILE");
  intrinsics
      ->add_option("--rig-from", arguments->rig_from, "Experiment whose cameras are copied into the rig file")
      ->type_name("EXPERIMENT");
  intrinsics->add_flag("--json", arguments->json,
                       "Print one JSON document with covariances and all pictures");
  intrinsics->callback([&chosen, arguments] {
    chosen = [arguments] { return intrinsics_command(*arguments, std::cout, std::cerr); };
  });
}

}  // namespace

void add_picture_commands(CLI::App& app, Command& chosen) {
  add_render(app, chosen);
  add_measure(app, chosen);
  add_estimate(app, chosen);
  add_intrinsics(app, chosen);
  add_board(app, chosen);
}

}  // namespace flexura
