#include "bench/embree_peer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "bench/peer_mesh.h"

namespace flexura {
namespace {

constexpr int packet = 8;
alignas(32) constexpr std::array<int, packet> all_rays = {-1, -1, -1, -1, -1, -1, -1, -1};

float gray_share(const Eigen::Vector3f& albedo) { return static_cast<float>(gray_of(albedo.cast<double>())); }

template <typename Value>
Value* new_buffer(RTCGeometry geometry, RTCBufferType type, unsigned slot, RTCFormat format,
                  std::size_t count) {
  return static_cast<Value*>(rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(Value), count));
}

class EmbreePeer final : public Peer {
 public:
  EmbreePeer(const Setting& setting, EmbreeShape shape, int rays_across)
      : view_(setting.view),
        light_(light_in_camera(setting)),
        ambient_(static_cast<float>(setting.scene.light.ambient)),
        directional_(static_cast<float>(setting.scene.light.directional)),
        middle_(Eigen::Vector2d(lens().cx, lens().cy).cast<float>()),
        slope_(Eigen::Vector2d(1 / lens().fx, 1 / lens().fy).cast<float>()),
        rays_across_(rays_across),
        device_(rtcNewDevice("threads=1")),
        scene_(rtcNewScene(device_)),
        gray_(view_.width, view_.height),
        depth_(view_.width, view_.height) {
    if (view_.width % packet != 0) throw std::invalid_argument("Embree: rays go by eight");
    Setting meshed = setting;
    if (shape == EmbreeShape::curves) {
      add_curves(setting);
      meshed.scene.arm = {};
    }
    mesh_ = mesh_of(meshed);
    first_of_screens_ = static_cast<unsigned>(mesh_.triangles.size() / 3 - 2 * setting.scene.screens.size());
    add_mesh();
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
  }
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;
  ~EmbreePeer() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void draw() override {
    for (int v = 0; v < view_.height; ++v)
      for (int u = 0; u < view_.width; u += packet) draw_packet(u, v);
  }

  PeerPicture picture() override {
    draw();
    return {gray_, depth_};
  }

 private:
  [[nodiscard]] const Intrinsics& lens() const { return view_.lens.intrinsics(); }

  void add_mesh() {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                     mesh_.corners.size());
    for (const Corner& corner : mesh_.corners)
      *corners++ = {corner.position.x(), corner.position.y(), corner.position.z()};
    auto* triangles = new_buffer<std::array<unsigned, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                          RTC_FORMAT_UINT3, mesh_.triangles.size() / 3);
    std::ranges::copy(mesh_.triangles, triangles->data());
    for (std::size_t i = 0; i < mesh_.triangles.size(); i += 3)
      albedo_of_triangle_.push_back(gray_share(mesh_.corners[mesh_.triangles[i]].albedo));
    attach(geometry, mesh_id);
  }

  void add_curves(const Setting& setting) {
    const ArmLook& arm = setting.scene.arm;
    const Pose X_CW = setting.view.X_WC.inverse();
    const std::vector<Strip> strips = strips_of(arm);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_ROUND_HERMITE_CURVE);
    auto* points = new_buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                    2 * strips.size());
    auto* tangents = new_buffer<std::array<float, 4>>(geometry, RTC_BUFFER_TYPE_TANGENT, 0, RTC_FORMAT_FLOAT4,
                                                      2 * strips.size());
    auto* firsts = new_buffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, strips.size());
    for (const Strip& strip : strips) {
      *firsts++ = static_cast<unsigned>(2 * albedo_of_curve_.size());
      albedo_of_curve_.push_back(gray_share(strip.albedo.cast<float>()));
      for (const double s : {strip.s_from, strip.s_to}) {
        const Pose X_CS = X_CW * pose_at(arm, s);
        const Eigen::Vector3f p = X_CS.position.cast<float>();
        const Eigen::Vector3f t = ((strip.s_to - strip.s_from) * X_CS.rotation.col(2)).cast<float>();
        *points++ = {p.x(), p.y(), p.z(), static_cast<float>(radius_of(arm))};
        *tangents++ = {t.x(), t.y(), t.z(), 0};
      }
    }
    attach(geometry, curves_id);
  }

  void attach(RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void draw_packet(int u, int v) {
    std::array<float, packet> light = {};
    std::array<float, packet> depth = {};
    depth.fill(std::numeric_limits<float>::infinity());
    for (int row = 0; row < rays_across_; ++row)
      for (int column = 0; column < rays_across_; ++column)
        add_rays(place_of(u, column), place_of(v, row), light, depth);
    const float full = 255.0f / static_cast<float>(rays_across_ * rays_across_);
    for (int i = 0; i < packet; ++i) {
      const auto lane = static_cast<std::size_t>(i);
      gray_.at(u + i, v) = static_cast<std::uint8_t>(std::min(255.0f, light[lane] * full + 0.5f));
      depth_.at(u + i, v) = depth[lane];
    }
  }

  // Returns the image coordinate of one of the rays of a pixel.
  [[nodiscard]] float place_of(int pixel, int ray) const {
    return static_cast<float>(pixel) - 0.5f +
           (static_cast<float>(ray) + 0.5f) / static_cast<float>(rays_across_);
  }

  // Adds rays for eight pixels in a row; `u` and `v` are the first ray's coordinates.
  void add_rays(float u, float v, std::array<float, packet>& light, std::array<float, packet>& depth) const {
    const float x = (u - middle_.x()) * slope_.x(), y = (v - middle_.y()) * slope_.y();
    RTCRayHit8 rays = {};
    for (int i = 0; i < packet; ++i) {
      rays.ray.dir_x[i] = x + static_cast<float>(i) * slope_.x();
      rays.ray.dir_y[i] = y;
      rays.ray.dir_z[i] = 1;  // Makes tfar the depth.
      rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
      rays.ray.mask[i] = ~0U;
      rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context = {};
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(all_rays.data(), scene_, &context, &rays);
    for (std::size_t i = 0; i < packet; ++i) {
      light[i] += light_of(rays.hit, i);
      depth[i] = std::min(depth[i], rays.ray.tfar[i]);
    }
  }

  [[nodiscard]] float light_of(const RTCHit8& hit, std::size_t i) const {
    if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) return 0;
    const unsigned place = hit.primID[i];
    if (hit.geomID[i] == curves_id)
      return shade({hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]}, albedo_of_curve_[place]);
    if (place >= first_of_screens_) return ambient_ * albedo_of_triangle_[place];
    const std::uint32_t* const corners = &mesh_.triangles[std::size_t{3} * place];
    const float u = hit.u[i], v = hit.v[i];
    return shade((1 - u - v) * mesh_.corners[corners[0]].normal + u * mesh_.corners[corners[1]].normal +
                     v * mesh_.corners[corners[2]].normal,
                 albedo_of_triangle_[place]);
  }

  [[nodiscard]] float shade(const Eigen::Vector3f& normal, float albedo) const {
    const float shine = normal.dot(light_) / normal.norm();
    return albedo * (ambient_ + directional_ * std::max(0.0f, shine));
  }

  static constexpr unsigned mesh_id = 0, curves_id = 1;

  View view_;
  Eigen::Vector3f light_;
  float ambient_, directional_;
  Eigen::Vector2f middle_, slope_;  // Mapping from pixels to rays.
  int rays_across_;
  RTCDevice device_;
  RTCScene scene_;
  PeerMesh mesh_;
  unsigned first_of_screens_ = 0;
  std::vector<float> albedo_of_triangle_, albedo_of_curve_;  // Gray values.
  Image<std::uint8_t> gray_;
  Image<float> depth_;
};

}  // namespace

std::unique_ptr<Peer> embree_peer(const Setting& setting, EmbreeShape shape, int rays_across) {
  return std::make_unique<EmbreePeer>(setting, shape, rays_across);
}

}  // namespace flexura
