#include "flexura/servo/servo_step.h"

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "flexura/base/table.h"

namespace flexura {
namespace {

// A table whose fields may be parts of members. `Part` has functions `get`, which returns the value from a
// step, and `set`, which stores a value in one.
class StepTable : public Table<ServoStep> {
 public:
  using Table::Table;

  template <class M>
  StepTable& field(std::string name, M ServoStep::* member, Spec spec) {
    Table::field(std::move(name), member, std::move(spec));
    return *this;
  }

  template <class Part>
  StepTable& part(std::string name, Spec spec) {
    using Value = decltype(Part::get(ServoStep{}));
    static constexpr ValueCodec codec = {
        [](const Node& node, const Spec& measured, Reader& reader, void* step) {
          Value value{};
          if (!Codec<Value>::read(node, measured, reader, value)) return false;
          Part::set(*static_cast<ServoStep*>(step), std::move(value));
          return true;
        },
        [](const void* step) { return Codec<Value>::write(Part::get(*static_cast<const ServoStep*>(step))); },
        [] { return Codec<Value>::type(); }};
    static const ServoStep defaults;
    add(std::move(name), 0, codec, &defaults, std::move(spec));
    return *this;
  }
};

using Bends = std::vector<std::array<double, 2>>;
using Numbers = std::vector<double>;

Bends bends_of_log(const std::vector<Eigen::Vector2d>& bends) {
  Bends list;
  list.reserve(bends.size());
  for (const Eigen::Vector2d& bend : bends) list.push_back({bend.x(), bend.y()});
  return list;
}

std::vector<Eigen::Vector2d> bends_from_log(const Bends& list) {
  std::vector<Eigen::Vector2d> bends;
  bends.reserve(list.size());
  for (const auto& bend : list) bends.emplace_back(bend[0], bend[1]);
  return bends;
}

// Returns the value of an optional member, which it creates if missing.
template <class Value>
Value& made(std::optional<Value>& member) {
  return member ? *member : member.emplace();
}

template <ArmState ServoStep::* state>
struct BendsOf {
  static Bends get(const ServoStep& step) { return bends_of_log((step.*state).bends); }
  static void set(ServoStep& step, const Bends& list) { (step.*state).bends = bends_from_log(list); }
};
template <ArmState ServoStep::* state>
struct StretchesOf {
  static Numbers get(const ServoStep& step) { return (step.*state).stretches; }
  static void set(ServoStep& step, Numbers list) { (step.*state).stretches = std::move(list); }
};

struct SeenBends {
  static std::optional<Bends> get(const ServoStep& step) {
    return step.seen ? std::optional(bends_of_log(step.seen->bends)) : std::nullopt;
  }
  static void set(ServoStep& step, const std::optional<Bends>& list) {
    made(step.seen).bends = bends_from_log(*list);
  }
};
struct SeenStretches {
  static std::optional<Numbers> get(const ServoStep& step) {
    return step.seen ? std::optional(step.seen->stretches) : std::nullopt;
  }
  static void set(ServoStep& step, std::optional<Numbers> list) {
    made(step.seen).stretches = std::move(*list);
  }
};
struct TrueBends {
  static std::optional<Bends> get(const ServoStep& step) {
    return step.truth ? std::optional(bends_of_log(step.truth->bends)) : std::nullopt;
  }
  static void set(ServoStep& step, const std::optional<Bends>& list) {
    made(step.truth).bends = bends_from_log(*list);
  }
};
struct TrueLengths {
  static std::optional<Numbers> get(const ServoStep& step) {
    return step.truth ? std::optional(step.truth->lengths) : std::nullopt;
  }
  static void set(ServoStep& step, std::optional<Numbers> list) {
    made(step.truth).lengths = std::move(*list);
  }
};

template <double ServoError::* number>
struct SeenError {
  static std::optional<double> get(const ServoStep& step) {
    return step.error ? std::optional((*step.error).*number) : std::nullopt;
  }
  static void set(ServoStep& step, std::optional<double> value) { made(step.error).*number = *value; }
};
template <double ServoError::* number>
struct TrueError {
  static std::optional<double> get(const ServoStep& step) {
    return step.truth ? std::optional(step.truth->error.*number) : std::nullopt;
  }
  static void set(ServoStep& step, std::optional<double> value) { made(step.truth).error.*number = *value; }
};

// Omitted if empty.
struct Heads {
  static std::optional<std::vector<HeadCommand>> get(const ServoStep& step) {
    return step.heads.empty() ? std::nullopt : std::optional(step.heads);
  }
  static void set(ServoStep& step, std::optional<std::vector<HeadCommand>> heads) {
    step.heads = std::move(*heads);
  }
};
struct Limited {
  static std::optional<std::string> get(const ServoStep& step) {
    return step.limited.empty() ? std::nullopt : std::optional(step.limited);
  }
  static void set(ServoStep& step, std::optional<std::string> why) { step.limited = std::move(*why); }
};

}  // namespace

const Table<HeadCommand>& fields_of(const HeadCommand*) {
  using M = HeadCommand;
  static const auto table =
      Table<M>("flexura.HeadCommand", "Command of a camera's head.")
          .field("camera", &M::camera, {.meaning = "Name of the camera."})
          .field("pan", &M::pan, {.meaning = "Pan, rad; positive to the camera's left."})
          .field("tilt", &M::tilt, {.meaning = "Tilt, rad; positive upwards."})
          .field("zoom", &M::zoom, {.meaning = "Zoom, as a ratio or as a motor position."});
  return table;
}

const Table<ServoStep>& fields_of(const ServoStep*) {
  using S = ServoStep;
  using E = ServoError;
  static const auto table =
      StepTable("flexura.ServoStep", "One command of a servo and its inputs.")
          .field("time", &S::time, {.meaning = "Time of the command since the experiment's start, s."})
          .field("seen_at", &S::seen_at, {.meaning = "Middle of the exposure of the pictures used, s."})
          .part<BendsOf<&S::desired>>(
              "desired", {.meaning = "Target bend of each section at the time of the pictures, rad."})
          .part<StretchesOf<&S::desired>>(
              "desired_stretches", {.meaning = "Target stretch of each section at the time of the pictures."})
          .part<SeenBends>("seen", {.meaning = "Bend of each section estimated from the pictures, rad."})
          .part<SeenStretches>("seen_stretches",
                               {.meaning = "Stretch of each section estimated from the pictures."})
          .part<BendsOf<&S::sent>>("sent", {.meaning = "Commanded bend of each section, rad."})
          .part<StretchesOf<&S::sent>>("sent_stretches", {.meaning = "Commanded stretch of each section."})
          .part<Heads>("heads", {.meaning = "Commands of heads that follow the arm, sent with this command."})
          .field("lengths", &S::lengths, {.meaning = "Model length of each section without stretch, m."})
          .part<TrueBends>(
              "truth", {.meaning = "Simulated true bend of each section at the time of the pictures, rad."})
          .part<TrueLengths>("true_lengths", {.meaning = "Simulated true length of each section, including "
                                                         "its stretch, at the time of the pictures, m."})
          .part<SeenError<&E::rms>>("rms", {.meaning = "Distance of the observed shape from the target: root "
                                                       "mean square along the arm, share of its length."})
          .part<SeenError<&E::most>>("most", {.meaning = "Distance of the observed shape from the target: "
                                                         "maximum along the arm, share of its length."})
          .part<SeenError<&E::tip>>(
              "tip", {.meaning = "Distance of the observed tip from its target, share of the arm's length."})
          .part<TrueError<&E::rms>>("true_rms",
                                    {.meaning = "Distance of the simulated true shape from the target: root "
                                                "mean square along the arm, share of its length."})
          .part<TrueError<&E::most>>("true_most",
                                     {.meaning = "Distance of the simulated true shape from the target: "
                                                 "maximum along the arm, share of its length."})
          .part<TrueError<&E::tip>>(
              "true_tip",
              {.meaning = "Distance of the simulated true tip from its target, share of the arm's length."})
          .field("potential", &S::potential,
                 {.meaning = "Half the squared error of the law: rad^2 for the laws shape and potential, "
                             "otherwise px^2."})
          .field("fresh", &S::is_fresh, {.meaning = "Whether the pictures are new since the last command."})
          .field("singular", &S::is_singular,
                 {.meaning = "Whether the law is singular: some motion of the arm changes no feature."})
          .part<Limited>(
              "limited",
              {.meaning = "Why the limiter changed the law's command, or which limit restricts the law."});
  return table;
}

}  // namespace flexura
