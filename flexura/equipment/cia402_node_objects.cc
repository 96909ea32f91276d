// Dictionary of objects of the simulated drive.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "flexura/equipment/cia402_node.h"

namespace flexura {
namespace {

constexpr std::uint32_t unused_pdo = 0x80000000;  // Bit 31 of the identifier of a PDO.

constexpr std::uint32_t object_key(ObjectAddress object) {
  return std::uint32_t{object.index} << 8U | object.sub;
}

bool is_pdo_mapping(std::uint16_t index) {
  return (index >= 0x1600 && index <= 0x1601) || (index >= 0x1A00 && index <= 0x1A01);
}

}  // namespace

void Cia402Node::reset_objects() {
  const auto add = [&](std::uint16_t index, std::uint8_t sub, std::uint32_t value, int size = 4,
                       bool is_writable = true) {
    objects_.push_back({object_key({index, sub}), {value, size, is_writable}});
  };
  const std::uint32_t node = config_.node;
  objects_.clear();
  objects_.reserve(128);
  add(0x1000, 0, 0x00040192, 4, false);  // A stepper drive of profile 402.
  add(0x1001, 0, 0, 1, false);
  add(0x1016, 0, 1, 1, false), add(0x1016, 1, 0);
  add(0x1017, 0, 0, 2);
  add(0x1018, 0, 2, 1, false), add(0x1018, 1, 0, 4, false), add(0x1018, 2, 0x402, 4, false);
  for (std::uint16_t i = 0; i < 2; ++i) {
    const std::uint32_t rpdo = (i == 0 ? cob::rpdo1 : cob::rpdo2) + node;
    const std::uint32_t tpdo = cob::tpdo1 + 0x100U * i + node;
    for (const auto& [index, identifier] : {std::pair{0x1400 + i, rpdo | (i == 0 ? 0 : unused_pdo)},
                                            std::pair{0x1800 + i, tpdo | (i == 0 ? 0 : unused_pdo)}}) {
      add(static_cast<std::uint16_t>(index), 0, 2, 1, false);
      add(static_cast<std::uint16_t>(index), 1, identifier),
          add(static_cast<std::uint16_t>(index), 2, 255, 1);
    }
    for (const int index : {0x1600 + i, 0x1A00 + i})
      for (std::uint8_t sub = 0; sub <= 4; ++sub)
        add(static_cast<std::uint16_t>(index), sub, 0, sub == 0 ? 1 : 4);
  }
  add(0x1600, 0, 1, 1), add(0x1600, 1, 0x60400010), add(0x1A00, 0, 1, 1), add(0x1A00, 1, 0x60410010);
  add(0x6007, 0, 1, 2);
  add(0x6040, 0, 0, 2), add(0x605A, 0, 2, 2), add(0x6060, 0, 0, 1);
  add(0x6065, 0, 2000), add(0x6067, 0, 2), add(0x607A, 0, 0), add(0x607C, 0, 0);
  add(0x607D, 0, 2, 1, false), add(0x607D, 1, 0x80000000), add(0x607D, 2, 0x7FFFFFFF);
  add(0x6081, 0, 1000), add(0x6083, 0, 100000), add(0x6084, 0, 100000), add(0x6085, 0, 400000);
  add(0x6086, 0, 0, 2), add(0x6098, 0, 0, 1);
  add(0x6099, 0, 2, 1, false), add(0x6099, 1, 2000), add(0x6099, 2, 500), add(0x609A, 0, 100000);
  add(0x6502, 0, 0x21, 4, false);  // Profile position and homing.
  // The last of several entries for the same object counts.
  std::ranges::reverse(objects_);
  std::ranges::stable_sort(objects_, {}, &std::pair<std::uint32_t, Entry>::first);
  const auto doubles = std::ranges::unique(objects_, {}, &std::pair<std::uint32_t, Entry>::first);
  objects_.erase(doubles.begin(), doubles.end());
}

const Cia402Node::Entry* Cia402Node::find(ObjectAddress object) const {
  const std::uint32_t key = object_key(object);
  const auto found = std::ranges::lower_bound(objects_, key, {}, &std::pair<std::uint32_t, Entry>::first);
  return found != objects_.end() && found->first == key ? &found->second : nullptr;
}

std::uint32_t Cia402Node::value(std::uint16_t index, std::uint8_t sub) const {
  const Entry* entry = find({index, sub});
  return entry == nullptr ? 0 : entry->value;
}

std::int32_t Cia402Node::number(std::uint16_t index, std::uint8_t sub) const {
  const Entry* entry = find({index, sub});
  if (entry == nullptr) return 0;
  if (entry->size == 1) return static_cast<std::int8_t>(entry->value);
  return entry->size == 2 ? static_cast<std::int16_t>(entry->value) : static_cast<std::int32_t>(entry->value);
}

std::optional<std::uint32_t> Cia402Node::live_value(ObjectAddress object) const {
  if (object.sub != 0) return std::nullopt;
  const auto bits = [](double number) {
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::lround(std::clamp(number, -2147483648.0, 2147483647.0))));
  };
  switch (object.index) {
    case 0x1001:
      return error_ != 0 ? 1U : 0U;
    case 0x603F:
      return error_;
    case 0x6041:
      return statusword(now_);
    case 0x6061:
      return value(0x6060);
    case 0x6062:
      return bits(ramp_.position(now_));
    case 0x6064:
      return bits(position(now_));
    case 0x606C:
      return bits(velocity(now_));
    default:
      return std::nullopt;
  }
}

SdoServer::ReadResult Cia402Node::read_object(ObjectAddress object) const {
  if (object == ObjectAddress{0x1008, 0}) return config_.name;
  if (object == ObjectAddress{0x1009, 0} || object == ObjectAddress{0x100A, 0}) return std::string("1.0");
  if (const auto live = live_value(object)) {
    const bool is_byte = object.index == 0x1001 || object.index == 0x6061;
    const bool is_word = object.index == 0x603F || object.index == 0x6041;
    const int wide = is_word ? 2 : 4;
    return little_endian(*live, is_byte ? 1 : wide);
  }
  if (const Entry* entry = find(object)) return little_endian(entry->value, entry->size);
  const bool has_index = find({object.index, 0}) != nullptr || live_value({object.index, 0}).has_value();
  return has_index ? abort_code::no_sub : abort_code::no_object;
}

// Returns why a mapping cannot be set so, or 0.
std::uint32_t Cia402Node::mapping_problem(ObjectAddress object, std::uint32_t mapped) const {
  const auto parameters = static_cast<std::uint16_t>(object.index - 0x200);
  if (defect_ == Cia402Defect::keeps_mapping) return abort_code::read_only;
  if ((value(parameters, 1) & unused_pdo) == 0) return abort_code::wrong_state;
  if (object.sub == 0) {
    unsigned bits = 0;
    if (mapped > 4) return abort_code::pdo_too_long;
    for (unsigned sub = 1; sub <= mapped; ++sub)
      bits += value(object.index, static_cast<std::uint8_t>(sub)) & 0xFF;
    return bits > 64 ? abort_code::pdo_too_long : 0;
  }
  if (value(object.index, 0) != 0) return abort_code::wrong_state;
  static constexpr std::array<std::uint32_t, 9> received = {
      0x60400010, 0x607A0020, 0x60810020, 0x60830020, 0x60840020, 0x60600008, 0, 0, 0};
  static constexpr std::array<std::uint32_t, 9> sent = {
      0x60410010, 0x60640020, 0x603F0010, 0x60610008, 0x60620020, 0x606C0020, 0x607A0020, 0x60810020, 0};
  return std::ranges::count(object.index < 0x1A00 ? received : sent, mapped) > 0 ? 0
                                                                                 : abort_code::not_mappable;
}

std::uint32_t Cia402Node::write_object(ObjectAddress object, const std::string& bytes) {
  const Entry* found = find(object);
  if (found == nullptr) {
    const SdoServer::ReadResult seen = read_object(object);
    return std::holds_alternative<std::string>(seen) ? abort_code::read_only : std::get<std::uint32_t>(seen);
  }
  auto& entry = const_cast<Entry&>(*found);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  if (!entry.is_writable) return abort_code::read_only;
  if (bytes.size() != static_cast<std::size_t>(entry.size)) return abort_code::wrong_length;
  std::uint32_t written = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    written |= std::uint32_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
  if (is_pdo_mapping(object.index))
    if (const std::uint32_t code = mapping_problem(object, written); code != 0) return code;
  const bool is_rate = object.index == 0x6081 || object.index == 0x6083 || object.index == 0x6084 ||
                       object.index == 0x6085 || object.index == 0x6099 || object.index == 0x609A;
  if (is_rate && (written == 0 || written > 0x7FFFFFFF)) return abort_code::out_of_range;
  if (object.index == 0x6060 && written != 0 && written != 1 && written != 6) return abort_code::out_of_range;
  entry.value = written;
  if (object.index == 0x6040) take_controlword(static_cast<std::uint16_t>(written));
  if (object.index == 0x1017) next_heartbeat_ = now_;
  if (object.index == 0x1016) host_heard_.reset();
  if (object.index == 0x6060) is_homing_ = is_homed_ = homing_failed_ = is_acknowledged_ = false;
  return 0;
}

void Cia402Node::apply_pdo(const CanFrame& frame, std::uint16_t mapping) {
  std::size_t at = 0;
  std::optional<std::uint16_t> word;
  for (unsigned sub = 1; sub <= value(mapping, 0); ++sub) {
    const std::uint32_t mapped = value(mapping, static_cast<std::uint8_t>(sub));
    const auto size = static_cast<int>((mapped & 0xFF) / 8);
    if (at + static_cast<std::size_t>(size) > frame.size) {
      send(emergency_frame(config_.node, {0x8210, 0x10}));
      return;
    }
    const std::uint32_t number = number_at(frame, at, size);
    const ObjectAddress object{static_cast<std::uint16_t>(mapped >> 16U),
                               static_cast<std::uint8_t>(mapped >> 8U)};
    at += static_cast<std::size_t>(size);
    // The controlword comes last, so that it starts what the others say.
    if (object.index == 0x6040) {
      word = static_cast<std::uint16_t>(number);
    } else {
      (void)write_object(object, little_endian(number, size));
    }
  }
  if (word) (void)write_object({0x6040, 0}, little_endian(*word, 2));
}

CanFrame Cia402Node::tpdo(std::size_t i) const {
  CanFrame frame{.id = value(static_cast<std::uint16_t>(0x1800 + i), 1) & 0x7FF};
  const auto mapping = static_cast<std::uint16_t>(0x1A00 + i);
  for (unsigned sub = 1; sub <= value(mapping, 0); ++sub) {
    const std::uint32_t mapped = value(mapping, static_cast<std::uint8_t>(sub));
    const ObjectAddress object{static_cast<std::uint16_t>(mapped >> 16U),
                               static_cast<std::uint8_t>(mapped >> 8U)};
    const auto live = live_value(object);
    append(frame, live ? *live : value(object.index, object.sub), static_cast<int>((mapped & 0xFF) / 8));
  }
  return frame;
}

}  // namespace flexura
