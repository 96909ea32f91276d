#pragma once

#include <string_view>

#include "flexura/base/progress.h"

namespace flexura {

/// Hears how far a job is, and says nothing.
class Quiet : public Progress {
 public:
  void update(double, std::string_view) override {}
};

}  // namespace flexura
