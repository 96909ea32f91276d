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

/// A table in a chapter. Any texts.
struct ChapterTable {
  std::vector<std::string> columns;            ///< Headings.
  std::vector<std::vector<std::string>> rows;  ///< A cell per column.
};

/// A part of a report for measurements other than the motion.
struct Chapter {
  std::string heading;                     ///< Any text.
  std::string text;                        ///< Any text: a paragraph.
  std::vector<ReportFigure> figures;       ///< Names that are valid file names and unique in the report.
  std::vector<std::string> points = {};    ///< Any text: a list below the paragraph.
  bool is_first_tall = true;               ///< The first figure is as high as two.
  std::optional<ChapterTable> table = {};  ///< Below the paragraph, above the list.
  /// A list that is folded in below the other one; shown if it has items.
  struct Details {
    std::string heading;
    std::vector<std::string> points;
  };
  Details details = {};
};

/// Data of a finished run for its report.
struct ReportData {
  /// A task's start or end, or an event.
  struct Mark {
    double time = 0.0;  ///< In s.
    std::string kind;
    std::string text;
  };

  /// Violations and contacts of the motion, and remarks.
  struct Safety {
    struct Violation {
      double start = 0.0;                 ///< In s.
      double end = 0.0;                   ///< In s.
      std::vector<std::size_t> sections;  ///< From 0; drawn with a warning in that time.
      std::string text;                   ///< Shown beside its picture.
      /// Time of a separate picture, s; it should be among the report's times.
      std::optional<double> pictured_at = {};
      std::optional<Eigen::Vector3d> target = {};  ///< Target of the tip, world, m; drawn too.
    };
    /// A listed line: for one violation, or for all of a kind.
    struct Line {
      double start = 0.0;  ///< In s.
      std::string text;
    };
    std::vector<Violation> violations;
    std::vector<Line> lines;
    std::vector<std::string> remarks;
  };

  /// What came of a task.
  struct Outcome {
    std::string task;        ///< Any text: its name.
    std::string text;        ///< Any text: one line.
    bool is_reached = true;  ///< Otherwise marked.
  };

  std::string title;            ///< Any text.
  std::string condition = {};   ///< "done", "unsafe" or "failed", shown as a badge; "": none.
  std::string reason = {};      ///< Why it is not done; any text.
  std::string version;          ///< Version of Flexura.
  std::string experiment_text;  ///< The experiment file as run, shown unchanged.
  Arm arm;
  std::optional<ArmModel> model = {};  ///< Model of the commands. Default: the arcs of its sections.
  std::vector<double> times;           ///< In s, increasing; one per state, at least one.
  std::vector<ArmState> states;        ///< As run; finite.
  std::vector<Mark> events;            ///< In the order of time.
  std::size_t recorded = 0;            ///< States in the run's log, if more than the given ones.
  std::optional<Safety> safety;        ///< Missing: not checked, not shown.
  std::vector<ObstacleConfig> obstacles;
  CurveKind curve = CurveKind::arcs;  ///< Drawn as a line along the arm; the arm itself is drawn as its arcs.
  double tension = 0.5;               ///< Of CurveKind::catmull_rom.
  std::vector<Chapter> chapters = {};
  std::string headline = {};           ///< Any text: what came of the run, below the title. "": not shown.
  std::vector<Outcome> outcomes = {};  ///< Listed below it if there are several.
};

/// A picture as a file.
struct FigureFile {
  std::string file_name;  ///< "arm-start.svg".
  std::string svg;        ///< The file's text.
};

/// Returns the whole report as one HTML page that loads nothing, which its content security policy enforces.
/// The embedded data is limited: for a long run some 2000 states are kept, and the page states this. Throws
/// std::invalid_argument if times and states do not match or do not fit the arm.
[[nodiscard]] std::string report_html(const ReportData& data);

/// Returns the report's pictures and charts, for papers. All runs have arm-start, arm-middle, arm-end,
/// tip-path, tip and the figures of the chapters. Violations have arm-unsafe-1 and on, at their worst
/// moments, those of one moment together. Spatial arms have bends-x and bends-y; planar arms have bends,
/// archings and cord-angles. Stretches that change have stretches. Throws like report_html.
[[nodiscard]] std::vector<FigureFile> report_figures(const ReportData& data);

}  // namespace flexura
