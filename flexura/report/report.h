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
#include "flexura/report/space.h"

namespace flexura {

/// A table in a chapter, with any texts.
struct ChapterTable {
  std::vector<std::string> columns;            ///< Headings.
  std::vector<std::vector<std::string>> rows;  ///< Rows with a cell per column.
};

/// A part of a report on a subject other than the arm's motion.
struct Chapter {
  std::string heading;                ///< Any text.
  std::string text;                   ///< Paragraph; any text.
  std::vector<ReportFigure> figures;  ///< Figures; their names are valid file names and unique in the report.
  std::vector<std::string> points = {};    ///< List below the paragraph; any texts.
  bool is_first_tall = true;               ///< Whether the first figure has twice the usual height.
  std::optional<ChapterTable> table = {};  ///< Table between the paragraph and the list.
  /// A collapsed list below the list `points`. The list is shown if it has items.
  struct Details {
    std::string heading;
    std::vector<std::string> points;
  };
  Details details = {};
};

/// Data of a finished run for its report.
struct ReportData {
  /// A marked time: the start or end of a task, or an event.
  struct Mark {
    double time = 0.0;  ///< In s.
    std::string kind;
    std::string text;
  };

  /// Violations and contacts of the motion, and remarks.
  struct Safety {
    struct Violation {
      double start = 0.0;  ///< In s.
      double end = 0.0;    ///< In s.
      std::vector<std::size_t>
          sections;  ///< Indices of the sections that are marked with a warning while the violation lasts.
      std::string text;  ///< Text beside the drawing of the violation.
      /// If the violation has a separate drawing: the time of the drawing, s. This time should be one of the
      /// report's times.
      std::optional<double> pictured_at = {};
      std::optional<Eigen::Vector3d> target = {};  ///< Target of the tip in W, m. It is drawn too.
    };
    /// A line of the report's list of violations, for one violation or for a group.
    struct Line {
      double start = 0.0;  ///< In s.
      std::string text;
    };
    std::vector<Violation> violations;
    std::vector<Line> lines;
    std::vector<std::string> remarks;
  };

  /// Result of a task.
  struct Outcome {
    std::string task;  ///< Name of the task; any text.
    std::string text;  ///< Result in one line; any text.
    bool is_reached =
        true;  ///< Whether the task was successful. The page marks the line of a task that failed.
  };

  std::string title;            ///< Any text.
  std::string condition = {};   ///< "done", "unsafe" or "failed", shown as a badge; "": no badge.
  std::string reason = {};      ///< Reason why the condition is not "done"; any text.
  std::string version;          ///< Version of Flexura.
  std::string experiment_text;  ///< Text of the experiment file that was run, shown unchanged.
  Arm arm;
  std::optional<ArmModel> model = {};  ///< Model from commands to shapes; default: each section is an arc.
  std::vector<double> times;           ///< Times of the states, s, increasing; at least one.
  std::vector<ArmState> states;        ///< States of the arm in the run; finite.
  std::vector<Mark> events;            ///< Events in the order of time.
  std::size_t recorded =
      0;  ///< Number of states in the run's log, if it is larger than the number of given states.
  std::optional<Safety> safety;  ///< Violations and contacts; missing: the motion was not checked.
  std::vector<ObstacleConfig> obstacles;
  CurveKind curve =
      CurveKind::arcs;   ///< Curve that is drawn as a line along the arm; the arm itself is drawn as arcs.
  double tension = 0.5;  ///< Tension of CurveKind::catmull_rom.
  std::vector<Chapter> chapters = {};
  std::string headline = {};  ///< Result of the run, below the title; any text; "": not shown.
  std::vector<Outcome> outcomes =
      {};                  ///< Results of the tasks, listed below `headline` if there are several.
  ReportSpace space = {};  ///< Objects that the 3D view shows in addition to the arm.
};

/// A picture as a file.
struct FigureFile {
  std::string file_name;  ///< Name of the file, such as "arm-start.svg".
  std::string svg;        ///< Text of the file.
};

/// Returns the whole report as one HTML page. The page loads no other files; its content security policy
/// enforces this. For a long run, the page has only about 2000 states and mentions this. Throws
/// std::invalid_argument if times and states do not match or do not fit the arm.
[[nodiscard]] std::string report_html(const ReportData& data);

/// Returns the report's pictures and charts, for papers. All runs have arm-start, arm-middle, arm-end,
/// tip-path, tip and the figures of the chapters. Runs with violations have arm-unsafe-1, arm-unsafe-2, ...,
/// one for each of the worst moments. Runs of spatial arms have bends-x and bends-y; those of planar arms
/// have bends, archings and cord-angles. Runs in which stretches change have stretches. Throws the exceptions
/// of report_html().
[[nodiscard]] std::vector<FigureFile> report_figures(const ReportData& data);

}  // namespace flexura
