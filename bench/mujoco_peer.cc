#include "bench/mujoco_peer.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "bench/egl_context.h"
#include "bench/peer_mesh.h"
#include "flexura/base/degree.h"

namespace flexura {
namespace {

constexpr int capsules = 60;
constexpr double nearest = 0.5, farthest = 4;  // m

std::string text(const Eigen::Vector3d& one) { return fmt::format("{} {} {}", one.x(), one.y(), one.z()); }

std::string capsule(const ArmLook& arm, int i) {
  const double length = length_of(arm) / capsules, s = i * length;
  const auto ring = std::ranges::find_if(arm.markers, [&](const MarkerRing& one) {
    return s + length / 2 > one.s_from && s + length / 2 < one.s_to;
  });
  return fmt::format("<geom type='{}' size='{}' fromto='{} {}' rgba='{} 1'/>\n",
                     i == 0 || i == capsules - 1 ? "cylinder" : "capsule", radius_of(arm),
                     text(pose_at(arm, s).position), text(pose_at(arm, s + length).position),
                     text(ring == arm.markers.end() ? arm.albedo : ring->albedo));
}

// Returns the screen, with an emission that gives full brightness together with the light falling on it.
std::string screen(const Screen& screen, const Light& light) {
  const double shine = std::max(0.0, screen.X_WS.rotation.col(2).dot(light.direction.normalized()));
  const double emission = 1 - light.ambient - light.directional * shine;
  const Pose& X_WS = screen.X_WS;
  return fmt::format("<geom type='plane' size='{} {} 1' pos='{}' xyaxes='{} {}' material='screen'/>\n",
                     screen.size[0] / 2, screen.size[1] / 2, text(X_WS.position), text(X_WS.rotation.col(0)),
                     text(X_WS.rotation.col(1))) +
         fmt::format(
             "</worldbody><asset><material name='screen' emission='{}' specular='0' rgba='{} 1'/></asset>",
             emission, text(screen.brightness));
}

std::string model_of(const Setting& setting, MujocoConfig config) {
  const View& view = setting.view;
  const Light& light = setting.scene.light;
  // MuJoCo's cameras look along -z, with y up.
  const Eigen::Vector3d right = view.X_WC.rotation.col(0), up = -view.X_WC.rotation.col(1);
  const double height_angle = 2 * std::atan(0.5 * view.height / view.lens.intrinsics().fy);
  std::string model = fmt::format(
      "<mujoco><statistic extent='1'/><visual><headlight active='0'/><quality offsamples='{}' shadowsize='0' "
      "numslices='{}' numstacks='{}'/><map znear='{}' zfar='{}'/><global offwidth='{}' "
      "offheight='{}'/></visual>\n"
      "<asset><material name='arm' specular='0'/></asset><default><geom material='arm'/></default>"
      "<worldbody><camera name='camera' pos='{}' xyaxes='{} {}' fovy='{}'/>\n",
      config.samples, config.slices, config.stacks, nearest, farthest, view.width, view.height,
      text(view.X_WC.position), text(right), text(up), height_angle / degree);
  const std::string ambient = text(Eigen::Vector3d::Constant(light.ambient));
  const std::string directional = text(Eigen::Vector3d::Constant(light.directional));
  model += fmt::format(
      "<light directional='true' castshadow='false' dir='{}' ambient='{}' diffuse='{}' specular='0 0 0'/>\n",
      text(-light.direction.normalized()), ambient, directional);
  for (int i = 0; i < capsules; ++i) model += capsule(setting.scene.arm, i);
  return model + screen(setting.scene.screens.front(), light) + "</mujoco>";
}

mjModel* load(const std::string& model) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "arm.xml", static_cast<int>(model.size()));
  std::ranges::copy(model, static_cast<char*>(files->filedata[0]));
  std::array<char, 1000> error = {};
  mjModel* result = mj_loadXML("arm.xml", files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  if (result == nullptr) throw std::runtime_error("MuJoCo: " + std::string(error.data()));
  return result;
}

class MujocoPeer final : public Peer {
 public:
  MujocoPeer(const Setting& setting, MujocoConfig config)
      : model_(load(model_of(setting, config))),
        data_(mj_makeData(model_)),
        rgb_(setting.view.width, setting.view.height, 3),
        depth_(setting.view.width, setting.view.height) {
    mj_forward(model_, data_);
    mjv_defaultOption(&option_);
    mjv_defaultCamera(&camera_);
    camera_.type = mjCAMERA_FIXED;
    camera_.fixedcamid = 0;
    mjv_defaultScene(&scene_);
    mjv_makeScene(model_, &scene_, 100);
    std::ranges::fill(scene_.flags, static_cast<mjtByte>(0));
    scene_.flags[mjRND_CULL_FACE] = 1;
    mjr_defaultContext(&drawing_);
    mjr_makeContext(model_, &drawing_, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &drawing_);
  }
  MujocoPeer(const MujocoPeer&) = delete;
  MujocoPeer& operator=(const MujocoPeer&) = delete;
  ~MujocoPeer() override {
    mjr_freeContext(&drawing_);
    mjv_freeScene(&scene_);
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void draw() override {
    const mjrRect all = {0, 0, rgb_.width(), rgb_.height()};
    mjv_updateScene(model_, data_, &option_, nullptr, &camera_, mjCAT_ALL, &scene_);
    mjr_render(all, &scene_, &drawing_);
    mjr_readPixels(rgb_.values().data(), depth_.values().data(), all, &drawing_);
  }

  PeerPicture picture() override {
    draw();
    const int width = rgb_.width(), height = rgb_.height();
    PeerPicture result{{width, height, 3}, {width, height}};
    for (int v = 0; v < height; ++v) {
      std::ranges::copy(rgb_.row(height - 1 - v), result.pixels.row(v).begin());
      std::ranges::transform(depth_.row(height - 1 - v), result.depth.row(v).begin(), [](float depth) {
        return static_cast<float>(nearest * farthest / (farthest - depth * (farthest - nearest)));
      });
    }
    return result;
  }

 private:
  EglContext context_{LlvmpipeThreads::none};
  mjModel* model_;
  mjData* data_;
  Image<std::uint8_t> rgb_;  // Rows from the bottom.
  Image<float> depth_;
  mjvOption option_{};
  mjvCamera camera_{};
  mjvScene scene_{};
  mjrContext drawing_{};
};

}  // namespace

std::unique_ptr<Peer> mujoco_peer(const Setting& setting, MujocoConfig config) {
  return std::make_unique<MujocoPeer>(setting, config);
}

}  // namespace flexura
