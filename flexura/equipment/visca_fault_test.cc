#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <string>

#include "flexura/base/degree.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/equipment/visca_head.h"
#include "tests/support/visca_wire.h"

// Moves over a link with faults. The time is that of the wire, so these tests need no waiting.
namespace flexura {
namespace {

struct ViscaFault {
  const char* name;
  LinkFaults faults;
};

const std::vector<ViscaFault>& visca_faults() {
  static const std::vector<ViscaFault> all{{"lost", {.lose = 0.2}},
                                           {"doubled", {.repeat = 0.3}},
                                           {"cut", {.cut = 0.15}},
                                           {"damaged", {.damage = 0.1}},
                                           {"swapped", {.swap = 0.2}},
                                           {"delayed", {.delay = 0.3, .most_late = 0.15}},
                                           {"late", {.delay = 0.2, .most_late = 0.45}},
                                           {"all",
                                            {.lose = 0.05,
                                             .repeat = 0.05,
                                             .cut = 0.05,
                                             .damage = 0.05,
                                             .swap = 0.05,
                                             .delay = 0.05,
                                             .most_late = 0.2}}};
  return all;
}

// What the head truly did lately.
class ViscaWitness {
 public:
  explicit ViscaWitness(ViscaDevice& device, std::size_t head = 0) : device_(device), head_(head) {}
  void look(double time) {
    seen_.push_back({time, device_.counts(head_, time)});
    if (seen_.size() > most) seen_.pop_front();
  }
  // Returns whether each axis was at its count some time between `from` and `to`.
  [[nodiscard]] bool confirms(const ViscaCounts& counts, double from, double to) const {
    const auto first = std::ranges::lower_bound(seen_, from - step, {}, &Seen::time);
    const auto was = [&](std::int64_t ViscaCounts::* axis) {
      std::int64_t least = INT64_MAX, largest = INT64_MIN;
      for (auto one = first; one != seen_.end() && one->time <= to + step; ++one)
        least = std::min(least, one->at.*axis), largest = std::max(largest, one->at.*axis);
      return counts.*axis >= least - 1 && counts.*axis <= largest + 1;
    };
    return was(&ViscaCounts::pan) && was(&ViscaCounts::tilt) && was(&ViscaCounts::zoom);
  }

 private:
  struct Seen {
    double time;
    ViscaCounts at;
  };
  static constexpr std::size_t most = 20000;
  static constexpr double step = 0.002;
  ViscaDevice& device_;
  std::size_t head_;
  std::deque<Seen> seen_;
};

struct ViscaTrial {
  int reached = 0, wrong = 0, misplaced = 0;
  bool recovered = false;
};

ViscaConfig visca_fault_config(ViscaFraming framing) {
  ViscaConfig config;
  config.bus.link = "/dev/head@9600";
  config.bus.framing = framing;
  config.bus.tries = 5;
  config.confirm = true;
  return config;
}

// Commands targets one after the other, and reads until the head stands or a fault is reported.
ViscaTrial visca_trial(ViscaFraming framing, const LinkFaults& faults, std::uint64_t seed, int commands) {
  ViscaDevice device(framing);
  device.add({});
  ViscaWitness witness(device);
  auto made = std::make_unique<ViscaWire>(device, seed);
  ViscaWire& wire = *made;
  wire.on_step = [&](double time) { witness.look(time); };
  const ViscaConfig config = visca_fault_config(framing);
  const auto bus = std::make_shared<ViscaBus>(std::move(made), config.bus, [&] { return wire.time; });
  ViscaHead head(bus, config);
  EXPECT_TRUE(bus->start());
  EXPECT_TRUE(head.start());
  ViscaTrial trial;
  const auto go = [&](const HeadState& target) {
    if (!head.command(target)) return false;
    for (const double end = wire.time + 120; wire.time < end; wire.pass(0.03)) {
      const double asked = wire.time;
      const auto read = head.read();
      if (!read) return false;
      if (!witness.confirms(*head.counts(), asked, wire.time)) ++trial.wrong;
      if (read.value().moving) continue;
      const ViscaCounts wanted = visca_counts(config, target), at = device.counts(0, wire.time);
      if (std::abs(wanted.pan - at.pan) > 2 || std::abs(wanted.tilt - at.tilt) > 2 ||
          std::abs(wanted.zoom - at.zoom) > 16)
        ++trial.misplaced;
      return true;
    }
    return false;
  };
  wire.faults = faults;
  for (int i = 0; i < commands; ++i) {
    const HeadState target{(i * 37 % 120 - 60) * degree, (i * 23 % 80 - 20) * degree,
                           static_cast<double>(i * 4001 % 16000)};
    if (i % 7 == 6) (void)head.halt();
    if (go(target)) ++trial.reached;
  }
  wire.faults = {};
  wire.pass(2);
  trial.recovered = go({10 * degree, 5 * degree, 3000}) || go({10 * degree, 5 * degree, 3000});
  return trial;
}

class ViscaFaults : public testing::TestWithParam<ViscaFraming> {};
INSTANTIATE_TEST_SUITE_P(All, ViscaFaults,
                         testing::Values(ViscaFraming::stream, ViscaFraming::datagram, ViscaFraming::sony),
                         [](const auto& one) { return name_of(one.param); });

TEST_P(ViscaFaults, NoWrongPositionIsGoodAndTheHeadIsUsedAgain) {
  for (const ViscaFault& fault : visca_faults()) {
    const ViscaTrial trial = visca_trial(GetParam(), fault.faults, 1, 12);
    SCOPED_TRACE(fault.name);
    EXPECT_EQ(trial.wrong, 0);
    EXPECT_EQ(trial.misplaced, 0);
    EXPECT_TRUE(trial.recovered);
    EXPECT_GT(trial.reached, 0);
  }
}

// Ten minutes of faults on a chain of two heads.
TEST(ViscaFault, TwoHeadsOfAChainNeverReportAWrongPosition) {
  ViscaDevice device(ViscaFraming::stream);
  device.add({}), device.add({});
  std::array<ViscaWitness, 2> witnesses{ViscaWitness(device, 0), ViscaWitness(device, 1)};
  auto made = std::make_unique<ViscaWire>(device, 5);
  ViscaWire& wire = *made;
  wire.on_step = [&](double time) {
    for (ViscaWitness& witness : witnesses) witness.look(time);
  };
  ViscaConfig config = visca_fault_config(ViscaFraming::stream);
  const auto bus = std::make_shared<ViscaBus>(std::move(made), config.bus, [&] { return wire.time; });
  ViscaHead first(bus, config);
  config.address = 2;
  ViscaHead second(bus, config);
  const std::array<ViscaHead*, 2> heads{&first, &second};
  ASSERT_TRUE(bus->start());
  for (ViscaHead* head : heads) ASSERT_TRUE(head->start());
  wire.faults = {.lose = 0.03, .repeat = 0.03, .damage = 0.03, .delay = 0.05, .most_late = 0.2};
  int good = 0, wrong = 0, commands = 0;
  for (const double end = wire.time + 600; wire.time < end; wire.pass(0.2)) {
    for (std::size_t i = 0; i < heads.size(); ++i) {
      if (commands++ % 20 == 0) (void)heads[i]->command({0.01 * (commands % 100), 0.1, 10.0 * commands});
      const double asked = wire.time;
      if (!heads[i]->read()) continue;
      ++good;
      if (!witnesses[i].confirms(*heads[i]->counts(), asked, wire.time)) ++wrong;
    }
  }
  EXPECT_GT(good, commands / 2);
  EXPECT_EQ(wrong, 0);
  wire.faults = {};
  for (ViscaHead* head : heads) {
    ASSERT_TRUE(head->halt());
    EXPECT_TRUE(head->read());
  }
  EXPECT_FALSE(device.is_moving(0, wire.time) || device.is_moving(1, wire.time));
}

}  // namespace
}  // namespace flexura
