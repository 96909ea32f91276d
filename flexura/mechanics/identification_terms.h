#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/identification.h"

namespace flexura {

/// Returns the tendons whose friction coefficient is the parameter.
[[nodiscard]] std::vector<std::size_t> rubbing_tendons(const Rod& rod, const RodParameter& parameter);

/// A column of the equations of motion at one sample. Such a column consists of the factors of the window's
/// test function and of its derivative, and of the derivatives of both factors with respect to q and v.
/// Derivatives that were not requested are empty.
struct IdentificationTerm {
  Eigen::VectorXd bump = {}, slope = {};
  Eigen::MatrixXd bump_by_q = {}, bump_by_v = {}, slope_by_q = {}, slope_by_v = {};
};

/// Terms of the equations of motion of a rod that are linear in the parameters to identify.
class IdentificationTerms {
 public:
  /// Keeps a reference to `dynamics`, which contains the given rod. Throws std::invalid_argument for
  /// parameters that overlap, or that the rod does not have.
  IdentificationTerms(RodDynamics& dynamics, const std::vector<RodParameter>& parameters);
  ~IdentificationTerms();
  IdentificationTerms(const IdentificationTerms&) = delete;
  IdentificationTerms& operator=(const IdentificationTerms&) = delete;

  /// Returns the parameters of the given rod.
  [[nodiscard]] const Eigen::VectorXd& nominal() const;
  /// Returns the terms at a sample with the rates v: first the term without parameters, then the term of each
  /// parameter. Must be called for all samples of a record in order, because tendons with friction slide from
  /// one sample to the next.
  [[nodiscard]] std::vector<IdentificationTerm> at(const RodMotionRecordSample& sample,
                                                   const Eigen::VectorXd& v, const RodLoads& loads,
                                                   bool with_slopes);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flexura
