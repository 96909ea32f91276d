#pragma once

#include <vector>

#include "flexura/log/messages.h"
#include "flexura/math/pose.h"
#include "flexura/model/backbone.h"
#include "flexura/view/extras.h"
#include "flexura/view/state_message.h"

// How an arm truly lay, as a run's log has it (/arm/truth).
namespace flexura {

/// The ends of an arm's arcs, base first and its tip last.
using LoggedArm = std::vector<Pose>;

/// InputError: fewer than two, or what is no pose.
[[nodiscard]] LoggedArm logged_arm(const PosesMessage& message);
/// What lies `part` of the way from one to another; the nearer one where they have other arcs.
[[nodiscard]] LoggedArm between(const LoggedArm& from, const LoggedArm& to, double part);
/// One arc from each end to the next. InputError: these make no arm.
[[nodiscard]] std::vector<ArmSample> samples_of(const LoggedArm& arm);

/// Adds the true arm as a ghost where it differs from the commanded one: where a sample, the tip among
/// them, is more than 0.1 mm from the point at the same share of the commanded arm's length. Not where there
/// is a ghost of the truth already.
void add_true_arm(const std::vector<ArmSample>& truth, const Backbone& commanded, Extras& extras);

}  // namespace flexura
