#include "flexura/base/table.h"
#include "flexura/equipment/aravis_camera.h"

namespace flexura {

const Table<AravisConfig>& fields_of(const AravisConfig*) {
  static const auto table =
      Table<AravisConfig>("aravis", "Pictures from a GigE Vision or USB3 Vision camera.")
          .field("device", &AravisConfig::device,
                 {.meaning = "The camera's name as `arv-tool-0.8` lists it, or the address of a GigE Vision "
                             "camera.",
                  .default_text = "the first camera found"})
          .field("exposure", &AravisConfig::exposure,
                 {.meaning = "Exposure time.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 1e3),
                  .default_text = "as set in the camera"})
          .field("gain", &AravisConfig::gain,
                 {.meaning = "Gain in the camera's unit, mostly dB.", .default_text = "as set in the camera"})
          .field("packet_size", &AravisConfig::packet_size,
                 {.meaning =
                      "Size of GigE Vision packets, bytes; 0: the largest size that the network supports.",
                  .range = between(0, 16384)})
          .field(
              "packet_socket", &AravisConfig::packet_socket,
              {.meaning =
                   "Whether the program reads GigE Vision packets directly from the network interface, if it "
                   "has the permission. Use false for a camera that is simulated on the same computer."})
          .field("silence", &AravisConfig::silence,
                 {.meaning = "Time without a frame after which the program reconnects.",
                  .unit = Unit::second,
                  .range = between(0.1, 600)})
          .field("longest_pause", &AravisConfig::longest_pause,
                 {.meaning = "Longest pause between two attempts to connect.",
                  .unit = Unit::second,
                  .range = between(0.1, 600)});
  return table;
}

}  // namespace flexura
