// A network camera for tests: an RTSP server (library gst-rtsp-server) that sends numbered pictures.
//
//   rtsp_peer PORT ENCODING WIDTH HEIGHT RATE
//
// PORT 0: any that is free. ENCODING: raw, jpeg, h264, or lossy (raw, and
// one packet in 701 is not sent). Prints "port N", then serves rtsp://127.0.0.1:N/ until its
// standard input ends. Every connection's pictures are numbered from 0: bit b of the number is the brightness
// of the square of 16 x 16 px at column 16 b in the top left corner.

#include <gst/app/gstappsrc.h>
#include <gst/gst.h>
#include <gst/rtsp-server/rtsp-server.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

constexpr int square = 16, bits = 16;

struct Format {
  std::string encoding;
  int width = 0, height = 0, rate = 0;
};

struct Source {
  Format format;
  std::uint64_t number = 0;
  std::uint64_t packets = 0;
};

// A gray picture in I420.
std::vector<std::uint8_t> picture(const Format& format, std::uint64_t number) {
  const auto width = std::size_t(format.width), height = std::size_t(format.height);
  std::vector<std::uint8_t> bytes(width * height * 3 / 2, 128);
  for (std::size_t v = 0; v < square; ++v)
    for (std::size_t u = 0; u < std::size_t(square * bits); ++u)
      bytes[v * width + u] = ((number >> (u / square)) & 1U) != 0 ? 235 : 16;
  return bytes;
}

void on_need_data(GstElement* element, guint /*size*/, gpointer data) {
  auto& source = *static_cast<Source*>(data);
  const auto bytes = picture(source.format, source.number);
  GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
  const auto rate = guint64(source.format.rate);
  GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(source.number, GST_SECOND, rate);
  GST_BUFFER_DURATION(buffer) = GST_SECOND / rate;
  ++source.number;
  gst_app_src_push_buffer(GST_APP_SRC(element), buffer);
}

// Keeps some packets back.
GstPadProbeReturn on_packets(GstPad* /*pad*/, GstPadProbeInfo* info, gpointer data) {
  auto& count = static_cast<Source*>(data)->packets;
  const auto is_lost = [&] { return ++count % 701 == 0; };
  if ((info->type & GST_PAD_PROBE_TYPE_BUFFER) != 0) return is_lost() ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
  GstBufferList* list = gst_buffer_list_make_writable(GST_PAD_PROBE_INFO_BUFFER_LIST(info));
  for (guint i = 0; i < gst_buffer_list_length(list);) {
    if (is_lost())
      gst_buffer_list_remove(list, i, 1);
    else
      ++i;
  }
  GST_PAD_PROBE_INFO_DATA(info) = list;
  return GST_PAD_PROBE_OK;
}

void on_media(GstRTSPMediaFactory* /*factory*/, GstRTSPMedia* media, gpointer data) {
  GstElement* element = gst_rtsp_media_get_element(media);
  GstElement* app = gst_bin_get_by_name_recurse_up(GST_BIN(element), "numbered");
  auto* source = new Source{*static_cast<Format*>(data)};
  g_object_set_data_full(G_OBJECT(media), "source", source,
                         [](gpointer old) { delete static_cast<Source*>(old); });
  g_signal_connect(app, "need-data", G_CALLBACK(on_need_data), source);
  gst_object_unref(app);
  if (source->format.encoding == "lossy") {
    GstElement* payloader = gst_bin_get_by_name_recurse_up(GST_BIN(element), "pay0");
    GstPad* pad = gst_element_get_static_pad(payloader, "src");
    const auto packets =
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST);
    gst_pad_add_probe(pad, packets, on_packets, source, nullptr);
    gst_object_unref(pad);
    gst_object_unref(payloader);
  }
  gst_object_unref(element);
}

std::string launch(const Format& format) {
  const std::string size = ",width=" + std::to_string(format.width) +
                           ",height=" + std::to_string(format.height) +
                           ",framerate=" + std::to_string(format.rate) + "/1";
  std::string pay = "rtpvrawpay";
  if (format.encoding == "jpeg") pay = "jpegenc quality=90 ! rtpjpegpay";
  if (format.encoding == "h264") pay = "openh264enc ! rtph264pay config-interval=1";
  return "( appsrc name=numbered is-live=true format=time caps=video/x-raw,format=I420" + size + " ! " + pay +
         " name=pay0 pt=96 )";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: rtsp_peer PORT ENCODING WIDTH HEIGHT RATE\n");
    return 2;
  }
  Format format{argv[2], std::atoi(argv[3]), std::atoi(argv[4]), std::atoi(argv[5])};
  gst_init(nullptr, nullptr);
  GMainLoop* loop = g_main_loop_new(nullptr, FALSE);
  GstRTSPServer* server = gst_rtsp_server_new();
  gst_rtsp_server_set_address(server, "127.0.0.1");
  gst_rtsp_server_set_service(server, argv[1]);
  GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
  gst_rtsp_media_factory_set_launch(factory, launch(format).c_str());
  g_signal_connect(factory, "media-configure", G_CALLBACK(on_media), &format);
  GstRTSPMountPoints* mounts = gst_rtsp_server_get_mount_points(server);
  gst_rtsp_mount_points_add_factory(mounts, "/", factory);
  g_object_unref(mounts);
  if (gst_rtsp_server_attach(server, nullptr) == 0) {
    std::fprintf(stderr, "rtsp_peer: port %s is taken\n", argv[1]);
    return 1;
  }
  std::printf("port %d\n", gst_rtsp_server_get_bound_port(server));
  std::fflush(stdout);
  // The peer must not outlive its test.
  GIOChannel* input = g_io_channel_unix_new(STDIN_FILENO);
  g_io_add_watch(
      input, static_cast<GIOCondition>(G_IO_HUP | G_IO_IN),
      [](GIOChannel* /*channel*/, GIOCondition /*condition*/, gpointer data) -> gboolean {
        g_main_loop_quit(static_cast<GMainLoop*>(data));
        return FALSE;
      },
      loop);
  g_main_loop_run(loop);
  return 0;
}
