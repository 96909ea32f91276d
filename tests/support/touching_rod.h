#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"

namespace flexura {

/// A moving rod with contacts given by a config, at contact points `spacing` m apart.
struct TouchingRod {
  Rod rod;
  RodDynamics dynamics;
  RodContact contact;

  TouchingRod(const Rod& given, RodContactConfig config, double spacing = 0.01)
      : rod(given), dynamics(rod), contact(dynamics.chain(), touching_at(rod, config, spacing)) {
    dynamics.set_surroundings(&contact);
  }
  static RodContactConfig touching_at(const Rod& rod, RodContactConfig config, double spacing) {
    config.places = contact_places(rod, spacing);
    return config;
  }
  /// Advances until `until` in steps of `h`, each of which must converge; calls look(state) after each.
  template <typename Look>
  void go(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h, double until,
          Look&& look) {
    const long steps = std::lround((until - state.time) / h);
    for (long i = 0; i < steps; ++i) {
      const RodStep step = dynamics.step(state, tendons, loads, h);
      ASSERT_TRUE(step.converged()) << words(step.end) << " at " << state.time;
      look(state);
    }
  }
  void go(RodState& state, const TendonInput& tendons, const RodLoads& loads, double h, double until) {
    go(state, tendons, loads, h, until, [](const RodState&) {});
  }
  std::vector<ContactForce> touching(const RodState& state) {
    return contact.find(dynamics.point_motions(state));
  }
};

}  // namespace flexura
