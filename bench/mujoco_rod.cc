#include "bench/mujoco_rod.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <stdexcept>
#include <string>

namespace flexura {
namespace {

std::string xml_of(const RodSection& section, const Eigen::Vector3d& gravity, int joints,
                   MujocoIntegrator integrator, double step) {
  const double piece = section.length / joints;
  const double stiffness = section.stiffness_at(0)[3] / piece, damping = section.damping_at(0)[3] / piece;
  const char* name = integrator == MujocoIntegrator::euler      ? "Euler"
                     : integrator == MujocoIntegrator::implicit ? "implicit"
                                                                : "RK4";
  std::string xml = fmt::format(
      "<mujoco><option timestep='{}' gravity='{} {} {}' integrator='{}'><flag contact='disable' "
      "constraint='disable'/></option><worldbody>",
      step, gravity.x(), gravity.y(), gravity.z(), name);
  for (int i = 0; i < joints; ++i) {
    // From the middle of a piece to that of the next one, or to the end.
    const double length = i + 1 < joints ? piece : piece / 2;
    const double mass = section.mass_per_length_at(0) * length, radius = section.radius[0];
    const double across = mass * (3 * radius * radius + length * length) / 12,
                 along = mass * radius * radius / 2;
    xml += fmt::format(
        "<body pos='0 0 {}'><inertial pos='0 0 {}' mass='{}' diaginertia='{} {} {}'/>"
        "<joint type='hinge' axis='1 0 0' stiffness='{}' damping='{}'/>"
        "<joint type='hinge' axis='0 1 0' stiffness='{}' damping='{}'/>",
        i == 0 ? piece / 2 : piece, length / 2, mass, across, across, along, stiffness, damping, stiffness,
        damping);
  }
  xml += fmt::format("<site name='tip' pos='0 0 {}'/>", piece / 2);
  for (int i = 0; i < joints; ++i) xml += "</body>";
  return xml + "</worldbody></mujoco>";
}

}  // namespace

struct MujocoRod::Model {
  mjModel* model = nullptr;
  mjData* data = nullptr;
};

MujocoRod::MujocoRod(const RodSection& section, const Eigen::Vector3d& gravity, int joints,
                     MujocoIntegrator integrator, double step)
    : model_(std::make_unique<Model>()) {
  const std::string xml = xml_of(section, gravity, joints, integrator, step);
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), "rod.xml", static_cast<int>(xml.size())) != 0)
    throw std::runtime_error("MuJoCo takes no more files");
  xml.copy(static_cast<char*>(files->filedata[0]), xml.size());
  std::array<char, 1000> error{};
  model_->model = mj_loadXML("rod.xml", files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  if (model_->model == nullptr) throw std::runtime_error(error.data());
  model_->data = mj_makeData(model_->model);
}

MujocoRod::~MujocoRod() {
  if (model_->data != nullptr) mj_deleteData(model_->data);
  if (model_->model != nullptr) mj_deleteModel(model_->model);
}

void MujocoRod::reset() { mj_resetData(model_->model, model_->data); }
void MujocoRod::step() { mj_step(model_->model, model_->data); }

Eigen::Vector3d MujocoRod::tip() const {
  mj_kinematics(model_->model, model_->data);
  const mjtNum* site = model_->data->site_xpos;
  return {site[0], site[1], site[2]};
}

}  // namespace flexura
