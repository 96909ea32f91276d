#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/curves.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/obstacle.h"
#include "flexura/report/chart.h"

namespace flexura {

/// A part of a report for what its makers measured beside the motion.
struct Chapter {
  std::string heading;                   ///< Any text.
  std::string text;                      ///< Likewise: a paragraph.
  std::vector<ReportFigure> figures;     ///< Names that make file names, each once in the report.
  std::vector<std::string> points = {};  ///< Any text: a list below the paragraph.
  bool is_first_tall = true;             ///< The first figure is as high as two.
};

/// What a finished run hands to its report.
struct ReportData {
  /// Something that happened: a task's start or end, an event.
  struct Mark {
    double time = 0.0;  ///< s
    std::string kind;
    std::string text;
  };

  /// What the motion was found to break or touch, and what else is worth knowing of it.
  struct Safety {
    struct Violation {
      double start = 0.0;                 ///< s
      double end = 0.0;                   ///< s
      std::vector<std::size_t> sections;  ///< From 0; drawn with a warning in that time.
      std::string text;                   ///< Said beside its picture.
      /// When to draw it in a picture of its own, s; such a time should be among the report's times.
      std::optional<double> pictured_at = {};
      std::optional<Eigen::Vector3d> target = {};  ///< Where the tip should have come, world, m; drawn too.
    };
    /// What is listed: of one violation, or of all of a kind.
    struct Line {
      double start = 0.0;  ///< s
      std::string text;
    };
    std::vector<Violation> violations;
    std::vector<Line> lines;
    std::vector<std::string> remarks;
  };

  std::string title;            ///< Any text.
  std::string version;          ///< Flexura's.
  std::string experiment_text;  ///< The experiment file as run, shown as it is.
  Arm arm;
  std::optional<ArmModel> model = {};  ///< What commands make of it. None: its sections' arcs.
  std::vector<double> times;           ///< s, ascending; one a state, at least one.
  std::vector<ArmState> states;        ///< As run; finite.
  std::vector<Mark> events;            ///< In the order of time.
  std::size_t recorded = 0;      ///< States in the run's log, where they are more than those given here.
  std::optional<Safety> safety;  ///< Empty: not checked, not shown.
  std::vector<ObstacleConfig> obstacles;
  CurveKind curve = CurveKind::arcs;  ///< Drawn as a line along the arm; the arm itself is drawn as its arcs.
  double tension = 0.5;               ///< Of CurveKind::catmull_rom.
  std::vector<Chapter> chapters = {};
};

/// A picture as a file.
struct FigureFile {
  std::string file_name;  ///< "arm-start.svg"
  std::string svg;        ///< The file's text.
};

/// The whole report as one HTML page that loads nothing and, by its content security policy, could not. What
/// it embeds is bounded: of a long run it keeps some 2000 states, and says so. Throws std::invalid_argument
/// when times and states do not match or do not fit the arm.
[[nodiscard]] std::string report_html(const ReportData& data);

/// The report's pictures and charts, for papers: arm-start, arm-middle, arm-end, arm-unsafe-1 and on
/// (violations at their worst moments, those of one moment together), tip-path, bends (a spatial arm: bends-x
/// and bends-y), archings and cord-angles (planar arms), stretches (where they change), tip; and those of the
/// chapters. Throws as report_html does.
[[nodiscard]] std::vector<FigureFile> report_figures(const ReportData& data);

}  // namespace flexura
