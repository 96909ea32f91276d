#include "flexura/calibrate/loop_session.h"

#include "flexura/calibrate/arcs_loop.h"
#include "flexura/calibrate/etalon_loop.h"
#include "flexura/calibrate/look_loop.h"

namespace flexura {

LoopResult calibrate_by_loop(const RigPorts& ports, const RigModel& nominal, const LoopConfig& config,
                             RigSessionWatcher& watcher) {
  LookLoop loop(ports, nominal, config, watcher);
  const auto run = [&]() -> LookLoop::Error {
    switch (config.method) {
      case LoopMethod::etalon:
        return etalon_corrected(loop)->run();
      case LoopMethod::etalon_paper:
        return etalon_as_printed(loop)->run();
      case LoopMethod::arcs:
        return arcs_corrected(loop)->run(false);
      case LoopMethod::arcs_paper:
        return arcs_as_printed(loop)->run(true);
    }
    return "unknown calibration method";
  };
  return loop.finish(run());
}

}  // namespace flexura
