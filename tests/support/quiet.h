#pragma once

#include <string_view>

#include "flexura/base/progress.h"

namespace flexura {

/// A progress listener that ignores all reports.
class Quiet : public Progress {
 public:
  void update(double, std::string_view) override {}
};

}  // namespace flexura
