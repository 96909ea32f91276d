#include "flexura/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "embedded/figure_css.h"
#include "embedded/license.h"
#include "embedded/report_css.h"
#include "embedded/report_html.h"
#include "embedded/report_js.h"
#include "embedded/space_draw_js.h"
#include "embedded/space_js.h"
#include "embedded/uplot_iife_min_js.h"
#include "embedded/uplot_min_css.h"
#include "flexura/report/arm_drawing.h"
#include "flexura/report/charts.h"
#include "flexura/report/obstacle_drawing.h"
#include "flexura/report/page.h"

namespace flexura {
namespace {

constexpr std::size_t max_listed_events = 1000;

std::vector<ReportFigure> arm_figures(const ReportMotion& motion, const PlotScene& scene) {
  return {{"arm-start", arm_picture(motion, scene, 0, "start")},
          {"arm-middle", arm_picture(motion, scene, motion.middle, "middle")},
          {"arm-end", arm_picture(motion, scene, motion.end(), "end")}};
}

std::string unsafe_name(std::size_t k) { return fmt::format("arm-unsafe-{}", k + 1); }

PlotScene motion_scene(const ReportMotion& motion) {
  return scene_of(with_targets(with_obstacles(swept_box(motion), motion.obstacles), motion), motion.in_plane,
                  0.1 * motion.arm.length());
}

std::string figures_html(const std::vector<ReportFigure>& figures) {
  std::string html;
  for (const ReportFigure& figure : figures) html += figure_html(figure);
  return html;
}

std::string summary_html(const ReportMotion& motion) {
  const std::size_t sections = motion.arm.sections.size();
  const auto row = [](std::string_view name, std::string_view value) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, xml_escape(value));
  };
  const auto moment = [&](std::string_view name, std::size_t i) {
    return row(fmt::format("{} <small>t = {} s</small>", name, fixed(motion.times[i], 3)),
               motion.tip_text(i));
  };
  return row("arm", motion.arm.kind == ArmKind::planar ? "planar" : "spatial") +
         row("sections", fmt::format("{}", sections)) + row("length", fixed(motion.arm.length(), 3) + " m") +
         row("duration", fixed(motion.times.back() - motion.times.front(), 3) + " s") + moment("start", 0) +
         moment("middle", motion.middle) + moment("end", motion.end());
}

// Returns the results of the run, and of its tasks if there are several.
std::string outcome_html(const ReportData& data) {
  if (data.headline.empty()) return "";
  std::string html = fmt::format("<p class=\"outcome\">{}</p>\n", xml_escape(data.headline));
  if (data.outcomes.size() < 2) return html;
  html += "<ul class=\"outcomes\">\n";
  for (const ReportData::Outcome& outcome : data.outcomes)
    html += fmt::format("<li{}><strong>{}</strong> {}</li>\n", outcome.is_reached ? "" : " class=\"missed\"",
                        xml_escape(outcome.task), xml_escape(outcome.text));
  return html + "</ul>\n";
}

// Returns a time that moves the player there; plain text if there is no player.
std::string jump_html(double time, bool has_player) {
  const std::string text = fixed(time, 3);
  return has_player ? fmt::format("<button type=\"button\" class=\"jump\" data-time=\"{:.9g}\">{}</button>",
                                  time, text)
                    : text;
}

std::string events_html(const ReportData& data, bool has_player) {
  if (data.events.empty()) return "<p>None.</p>\n";
  std::string html =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Events\">\n<table>\n<thead><tr>"
      "<th scope=\"col\">time <small>s</small></th><th scope=\"col\">kind</th><th "
      "scope=\"col\">what</th></tr></thead>\n"
      "<tbody>\n";
  for (std::size_t i = 0; i < std::min(data.events.size(), max_listed_events); ++i) {
    const ReportData::Mark& event = data.events[i];
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", jump_html(event.time, has_player),
                        xml_escape(event.kind), xml_escape(event.text));
  }
  html += "</tbody>\n</table>\n</div>\n";
  if (data.events.size() > max_listed_events) {
    html +=
        fmt::format("<p class=\"note\">These are the first {} of {} events. The log has all events.</p>\n",
                    max_listed_events, data.events.size());
  }
  return html;
}

// As the viewer shows it: viewer/src/ui/ConditionBadge.tsx.
std::string badge_html(const ReportData& data) {
  if (data.condition.empty()) return "";
  std::string word = data.condition;
  std::ranges::transform(word, word.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format("<p class=\"condition\"><span class=\"badge\" data-kind=\"{}\">{}</span> {}</p>\n",
                     xml_escape(data.condition), xml_escape(word), xml_escape(data.reason));
}

std::string safety_html(const ReportData& data, bool has_player) {
  if (!data.safety) return "";
  const auto& [violations, lines, remarks] = *data.safety;
  std::string html =
      "<section aria-labelledby=\"safety-title\" class=\"safety\">\n<h2 id=\"safety-title\">Safety</h2>\n";
  if (violations.empty()) html += "<p>The motion keeps all limits, and the arm touches nothing.</p>\n";
  if (!violations.empty() || !remarks.empty()) html += "<ul>\n";
  for (std::size_t i = 0; i < std::min(lines.size(), max_listed_events); ++i) {
    html += fmt::format("<li>{} <span class=\"unsafe\">unsafe:</span> {}</li>\n",
                        jump_html(lines[i].start, has_player), xml_escape(lines[i].text));
  }
  if (lines.size() > max_listed_events)
    html += fmt::format("<li>and {} more</li>\n", lines.size() - max_listed_events);
  for (const std::string& remark : remarks) html += fmt::format("<li>{}</li>\n", xml_escape(remark));
  if (!violations.empty() || !remarks.empty()) html += "</ul>\n";
  return html + "</section>\n";
}

// Returns violations at their worst moments, each with its text and a button that moves the player to it.
std::string unsafe_html(const ReportMotion& motion, const PlotScene& scene) {
  if (motion.unsafe_moments.empty()) return "";
  std::string html = fmt::format(
      "<section aria-labelledby=\"worst-title\">\n<h2 id=\"worst-title\">The worst moments</h2>\n<div "
      "class=\"pictures {}\">\n",
      motion.in_plane ? "one" : "two");
  for (std::size_t k = 0; k < motion.unsafe_moments.size(); ++k) {
    const UnsafeMoment& moment = motion.unsafe_moments[k];
    const double time = motion.times[moment.state];
    html += fmt::format("<figure id=\"picture-{}\">\n{}<figcaption>{} {}</figcaption>\n</figure>\n",
                        unsafe_name(k), inline_svg(unsafe_picture(motion, scene, moment)),
                        jump_html(time, !motion.is_still), xml_escape(moment_text(motion, moment)));
  }
  return html + "</div>\n</section>\n";
}

std::string list_html(const std::vector<std::string>& points) {
  if (points.empty()) return "";
  std::string html = "<ul>\n";
  for (const std::string& point : points) html += fmt::format("<li>{}</li>\n", xml_escape(point));
  return html + "</ul>\n";
}

std::string details_html(const Chapter::Details& details) {
  if (details.points.empty()) return "";
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", xml_escape(details.heading),
                     list_html(details.points));
}

std::string chapters_html(const ReportData& data) {
  std::string html;
  for (std::size_t i = 0; i < data.chapters.size(); ++i) {
    const Chapter& chapter = data.chapters[i];
    html += fmt::format(
        "<section aria-labelledby=\"chapter-{0}\">\n<h2 id=\"chapter-{0}\">{1}</h2>\n<p>{2}</p>\n{3}<div "
        "class=\"charts{4}\">\n{5}</div>\n</section>\n",
        i + 1, xml_escape(chapter.heading), xml_escape(chapter.text),
        (chapter.table ? table_html(*chapter.table) : "") + list_html(chapter.points) +
            details_html(chapter.details),
        chapter.is_first_tall ? " chapter" : "", figures_html(chapter.figures));
  }
  return html;
}

// Returns links to the report's parts.
std::string contents_html(const ReportData& data, const ReportMotion& motion) {
  std::string html = "<nav class=\"contents\" aria-label=\"Contents\">\n";
  const auto add = [&](const std::string& id, const std::string& heading) {
    html += fmt::format("<a href=\"#{}\">{}</a>\n", id, xml_escape(heading));
  };
  if (!motion.is_still) add("player", "Motion");
  add("space", "In 3D");
  if (data.safety) add("safety-title", "Safety");
  if (!motion.unsafe_moments.empty()) add("worst-title", "The worst moments");
  add("arms-title", "The arm");
  if (!motion.is_still) add("charts-title", "Over time");
  for (std::size_t i = 0; i < data.chapters.size(); ++i)
    add(fmt::format("chapter-{}", i + 1), data.chapters[i].heading);
  add("events-title", "Events");
  add("file-title", "The experiment");
  return html + "</nav>\n";
}

// Returns the section of pictures of the arm: an arm that never moves has one.
std::string arms_html(const ReportMotion& motion, const PlotScene& scene) {
  std::vector<ReportFigure> arms = arm_figures(motion, scene);
  if (motion.is_still) {
    arms.resize(1);
  } else if (!motion.in_plane) {
    arms.push_back({"tip-path", tip_path_picture(motion)});
  }
  return fmt::format(
      "<section aria-labelledby=\"arms-title\">\n<h2 id=\"arms-title\">{}</h2>\n<div class=\"pictures "
      "{}\">\n{}</div>\n</section>\n",
      motion.is_still ? "The arm, which does not move" : "The arm at start, middle and end",
      motion.in_plane ? "one" : "two", figures_html(arms));
}

// Returns true if no line of the chart ever changes visibly.
bool is_constant(const ReportFigure& figure) {
  return std::ranges::all_of(std::get<LineChart>(figure.content).series, [](const ChartSeries& one) {
    constexpr double invisible = 1e-9;
    const auto [least, most] = std::ranges::minmax(one.values);
    return most - least < invisible;
  });
}

// Returns the section of charts over time, without those that never change.
std::string charts_html(const ReportMotion& motion) {
  if (motion.is_still) return "";
  std::vector<ReportFigure> charts = charts_of(motion);
  std::string hidden;
  for (const ReportFigure& figure : charts)
    if (is_constant(figure))
      hidden += (hidden.empty() ? "" : ", ") + std::get<LineChart>(figure.content).heading;
  std::erase_if(charts, is_constant);
  // Beside the last two, as high as both.
  if (motion.in_plane)
    charts.insert(charts.empty() ? charts.end() : charts.end() - 1, {"tip-path", tip_path_picture(motion)});
  const std::string note =
      hidden.empty() ? ""
                     : fmt::format("<p class=\"note\">Not shown, because it does not change: {}.</p>\n",
                                   xml_escape(hidden));
  return fmt::format(
      "<section aria-labelledby=\"charts-title\">\n<h2 id=\"charts-title\">Over time</h2>\n{}<div "
      "class=\"charts {}\">\n{}</div>\n</section>\n",
      note, motion.in_plane ? "one" : "two", figures_html(charts));
}

std::string thinned_html(const ReportMotion& motion) {
  if (motion.count() == motion.recorded) return "";
  return fmt::format(
      "<p class=\"note\">This page shows {} of the {} recorded states: an even selection and the states at "
      "events. The log has all states.</p>\n",
      motion.count(), motion.recorded);
}

std::string curve_html(const ReportMotion& motion) {
  if (motion.curve == CurveKind::arcs) return "";
  const std::string name =
      motion.curve == CurveKind::bezier
          ? "one Bezier curve per section, with exact tangents"
          : fmt::format("the Catmull-Rom spline through the sections' base points, tension {:.3g}",
                        motion.tension);
  const Backbone& backbone = motion.backbones.back();
  const CurveDeviation end = deviation(drawn_curve(backbone, motion.curve, motion.tension), backbone);
  return fmt::format(
      "<p class=\"note\">The dark line is {}; at the end, its distance from the arm's arcs is at most {:.2g} "
      "m, and the line is {:.2g} % {} than the arcs.</p>\n",
      name, end.distance, 100 * std::abs(end.length / backbone.length() - 1),
      end.length < backbone.length() ? "shorter" : "longer");
}

std::string policy() {
  return fmt::format(
      "default-src 'none'; img-src data:; script-src {} {} {} {}; style-src {} {} {}; base-uri 'none'; "
      "form-action "
      "'none'",
      csp_hash(embedded::uplot_iife_min_js_sha256), csp_hash(embedded::space_draw_js_sha256),
      csp_hash(embedded::space_js_sha256), csp_hash(embedded::report_js_sha256),
      csp_hash(embedded::uplot_min_css_sha256), csp_hash(embedded::figure_css_sha256),
      csp_hash(embedded::report_css_sha256));
}

}  // namespace

std::vector<FigureFile> report_figures(const ReportData& data) {
  const ReportMotion motion = motion_of(data);
  const PlotScene scene = motion_scene(motion);
  std::vector<FigureFile> files;
  const auto add = [&](const std::vector<ReportFigure>& figures) {
    for (const auto& [name, content] : figures) {
      const auto* drawing = std::get_if<Drawing>(&content);
      files.push_back(
          {name + ".svg",
           standalone_svg(drawing != nullptr ? *drawing : chart_picture(std::get<LineChart>(content)))});
    }
  };
  add(arm_figures(motion, scene));
  for (std::size_t k = 0; k < motion.unsafe_moments.size(); ++k)
    add({{unsafe_name(k), unsafe_picture(motion, scene, motion.unsafe_moments[k])}});
  add({{"tip-path", tip_path_picture(motion)}});
  add(charts_of(motion));
  for (const Chapter& chapter : data.chapters) add(chapter.figures);
  return files;
}

std::string report_html(const ReportData& data) {
  const ReportMotion motion = motion_of(data);
  const PlotScene scene = motion_scene(motion);
  return filled(embedded::report_html,
                {{"title", xml_escape(data.title)},
                 {"condition", badge_html(data)},
                 {"version", xml_escape(data.version)},
                 {"policy", policy()},
                 {"outcome", outcome_html(data)},
                 {"contents", contents_html(data, motion)},
                 {"figure_css", std::string(embedded::figure_css)},
                 {"report_css", std::string(embedded::report_css)},
                 {"report_js", std::string(embedded::report_js)},
                 {"space_draw_js", std::string(embedded::space_draw_js)},
                 {"space_js", std::string(embedded::space_js)},
                 {"space", space_json(data.space, motion)},
                 {"uplot_license", std::string(embedded::license)},
                 {"uplot_css", std::string(embedded::uplot_min_css)},
                 {"uplot_js", std::string(embedded::uplot_iife_min_js)},
                 {"summary", summary_html(motion)},
                 {"thinned", curve_html(motion) + thinned_html(motion)},
                 {"safety", safety_html(data, !motion.is_still) + unsafe_html(motion, scene)},
                 {"views", motion.in_plane ? "one" : "two"},
                 {"arms", arms_html(motion, scene)},
                 {"player", inline_svg(player_picture(motion, scene))},
                 {"charts", charts_html(motion)},
                 {"chapters", chapters_html(data)},
                 {"events", events_html(data, !motion.is_still)},
                 {"experiment", xml_escape(data.experiment_text)},
                 {"data", motion_json(motion)}});
}

}  // namespace flexura
