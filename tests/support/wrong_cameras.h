#pragma once

#include <vector>

#include "flexura/base/degree.h"
#include "flexura/camera/view.h"
#include "flexura/estimate/observation.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// In cameras that may be so wrong.
constexpr ViewPrior a_degree_and_two_percent = {.rotation_std = degree, .focal_std = 0.02};

struct WrongCameras {
  std::vector<Observation> seen;
  std::vector<ViewError> errors;
};

/// What both cameras see, which are believed to be `most` of half a degree and 1 % otherwise.
inline WrongCameras wrong_cameras(const Backbone& truth, TestRandom& random, double noise, double most = 1) {
  WrongCameras cameras{observations_of(truth, random, noise), {}};
  for (Observation& one : cameras.seen) {
    for (auto& end : one.ends) end->sigma = 0.1;
    const ViewError nominal{random.vector<3>(-0.5, 0.5) * most * degree, random.uniform(-0.01, 0.01) * most};
    const View is = one.view;
    one.view = corrected(is, nominal);
    one.view_prior = a_degree_and_two_percent;
    cameras.errors.push_back(
        {so3_log(one.view.X_WC.rotation.transpose() * is.X_WC.rotation), -nominal.focal});
  }
  return cameras;
}

}  // namespace flexura
