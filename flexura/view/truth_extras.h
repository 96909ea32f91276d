#pragma once

#include <vector>

#include "flexura/log/messages.h"
#include "flexura/math/pose.h"
#include "flexura/model/backbone.h"
#include "flexura/view/extras.h"
#include "flexura/view/state_message.h"

// The true arm in a run's log (/arm/truth).
namespace flexura {

/// Poses of the ends of an arm's arcs, from base to tip.
using LoggedArm = std::vector<Pose>;

/// Converts a logged message. Throws InputError for fewer than two poses, or an invalid pose.
[[nodiscard]] LoggedArm logged_arm(const PosesMessage& message);
/// Interpolates between two arms at the fraction `part`. Returns the nearer arm if the numbers of arcs
/// differ.
[[nodiscard]] LoggedArm between(const LoggedArm& from, const LoggedArm& to, double part);
/// Returns samples of the arm with one arc from each pose to the next. Throws InputError if these arcs do not
/// form an arm.
[[nodiscard]] std::vector<ArmSample> samples_of(const LoggedArm& arm);

/// Adds the true arm as a ghost if it differs from the commanded arm. The arms differ if the distance between
/// points at an equal fraction of the length exceeds 0.1 mm. Adds nothing if the extras already have a ghost
/// of the true arm.
void add_true_arm(const std::vector<ArmSample>& truth, const Backbone& commanded, Extras& extras);

}  // namespace flexura
