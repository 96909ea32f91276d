#include <array>
#include <string_view>
#include <utility>

#include "flexura/equipment/grbl_codec.h"

// Meanings of the numbers in error:N and ALARM:N. Sources: gnea/grbl, doc/csv/error_codes_en_US.csv and
// alarm_codes_en_US.csv; grblHAL/core, errors.h and alarms.h.
namespace flexura {
namespace {

using Meaning = std::pair<int, std::string_view>;

constexpr std::array<Meaning, 52> errors{
    {{1, "a letter is missing before a number"},
     {2, "a number is missing or not a number"},
     {3, "this $ command does not exist"},
     {4, "a negative number where only a positive one is allowed"},
     {5, "homing is not enabled (setting $22)"},
     {6, "a step pulse is shorter than 3 us"},
     {7, "the stored settings were unreadable, so the controller uses default settings"},
     {8, "this $ command needs the state Idle"},
     {9, "locked: an alarm or a jog is active"},
     {10, "soft limits need homing (settings $20 and $22)"},
     {11, "the line is too long"},
     {12, "the setting asks for more steps per second than the controller can make"},
     {13, "the safety door is open"},
     {14, "the startup line is too long"},
     {15, "the target is outside the travel (settings $130 and following)"},
     {16, "a jog line has no =, or contains a command that is not allowed in jogs"},
     {17, "laser mode needs a variable spindle"},
     {18, "a reset is asserted"},
     {19, "a number must be above 0"},
     {20, "unsupported command"},
     {21, "two commands of the same group in one line"},
     {22, "no feed rate is set"},
     {23, "a command's number must be whole"},
     {24, "two commands of one line both need axis words"},
     {25, "a word is repeated"},
     {26, "axis words are missing"},
     {27, "the line number is out of range"},
     {28, "a P or L word is missing"},
     {29, "this work coordinate system does not exist"},
     {30, "G53 needs G0 or G1"},
     {31, "axis words without a motion"},
     {32, "an arc without axis words in its plane"},
     {33, "the motion's target is invalid"},
     {34, "the arc's radius is impossible"},
     {35, "the arc's center is missing"},
     {36, "unused words in the line"},
     {37, "this axis cannot have a tool length offset"},
     {38, "the tool number is too large"},
     {39, "a parameter is out of range"},
     {40, "this command is not allowed while a tool change is pending"},
     {41, "the spindle is not running"},
     {42, "the plane must be XY for this command"},
     {43, "the feed rate is above the maximum"},
     {44, "the spindle speed is out of range"},
     {45, "a limit switch is active"},
     {46, "homing is required first"},
     {49, "the self-test failed"},
     {50, "an emergency stop is active"},
     {51, "a motor driver reports a fault"},
     {52, "the setting's value is out of range"},
     {53, "this setting is not available"},
     {79, "not allowed before the alarm is cleared by a reset"}}};

constexpr std::array<Meaning, 18> alarms{{{1, "a limit switch was hit in motion, the position is lost"},
                                          {2, "a motion's target is outside the travel"},
                                          {3, "reset in motion, the position is lost"},
                                          {4, "the probe was not in its initial state"},
                                          {5, "the probe touched nothing"},
                                          {6, "reset during homing"},
                                          {7, "the safety door opened during homing"},
                                          {8, "homing could not leave the limit switch"},
                                          {9, "homing found no limit switch"},
                                          {10, "emergency stop"},
                                          {11, "homing is required"},
                                          {12, "a limit switch is active"},
                                          {13, "probe protection"},
                                          {14, "the spindle does not answer"},
                                          {15, "homing found no second limit switch"},
                                          {16, "the self-test failed"},
                                          {17, "a motor driver reports a fault"},
                                          {18, "homing failed"}}};

template <std::size_t N>
std::string_view meaning(const std::array<Meaning, N>& all, int code) {
  for (const auto& [number, words] : all)
    if (number == code) return words;
  return "no meaning is documented for this number";
}

}  // namespace

std::string_view grbl_error_meaning(int code) { return meaning(errors, code); }
std::string_view grbl_alarm_meaning(int code) { return meaning(alarms, code); }

}  // namespace flexura
