#include "bench/llvmpipe_peer.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/peer_mesh.h"

namespace flexura {
namespace {

constexpr double nearest = 0.5, farthest = 4;  // m
// Depth z maps to depth_offset + depth_factor / z in OpenGL's range -1 to 1.
constexpr double depth_offset = (farthest + nearest) / (farthest - nearest);
constexpr double depth_factor = -2 * farthest * nearest / (farthest - nearest);

constexpr const char* vertex_source = R"(#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 albedo;
uniform vec4 lens;
uniform vec2 depth;
out vec3 normal_here;
out vec3 albedo_here;
void main() {
  normal_here = normal;
  albedo_here = albedo;
  gl_Position = vec4(lens.xy * position.xy + lens.zw * position.z, depth.x * position.z + depth.y, position.z);
}
)";

constexpr const char* fragment_source = R"(#version 330
in vec3 normal_here;
in vec3 albedo_here;
uniform vec3 light;
uniform vec2 ambient_and_directional;
uniform bool is_gray;
out vec4 color;
void main() {
  float shine = dot(normal_here, light) * inversesqrt(max(dot(normal_here, normal_here), 1e-6));
  vec3 shown = albedo_here * (ambient_and_directional.x + ambient_and_directional.y * max(0.0, shine));
  color = vec4(is_gray ? vec3(dot(shown, vec3(0.2126, 0.7152, 0.0722))) : shown, 1.0);
}
)";

void add_shader(GLuint program, GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glDeleteShader(shader);
}

GLuint make_program() {
  const GLuint program = glCreateProgram();
  add_shader(program, GL_VERTEX_SHADER, vertex_source);
  add_shader(program, GL_FRAGMENT_SHADER, fragment_source);
  glLinkProgram(program);
  GLint is_linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
  std::array<char, 1000> log = {};
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  if (is_linked == 0) throw std::runtime_error("OpenGL: " + std::string(log.data()));
  return program;
}

void add_plane(GLenum place, GLenum format, int samples, const View& view) {
  GLuint plane = 0;
  glGenRenderbuffers(1, &plane);
  glBindRenderbuffer(GL_RENDERBUFFER, plane);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, view.width, view.height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, plane);
}

// OpenGL objects live until the context is destroyed.
class LlvmpipePeer final : public Peer {
 public:
  LlvmpipePeer(const Setting& setting, LlvmpipeConfig config)
      : config_(config), view_(setting.view), context_(config.threads) {
    program_ = make_program();
    glUseProgram(program_);
    set_uniforms(setting);
    load(mesh_of(setting));
    target_ = make_target(config.samples);
    result_ = config.samples > 0 ? make_target(0) : target_;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, result_);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW);  // Rows start at the top: for OpenGL the image is upside down.
    glViewport(0, 0, view_.width, view_.height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    pixels_ = {view_.width, view_.height, is_gray() ? 1 : 4};
    depth_ = {view_.width, view_.height};
    if (glGetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL: the scene is refused");
  }

  void draw() override { draw(config_.reads_depth); }

  PeerPicture picture() override {
    draw(true);
    PeerPicture result{{view_.width, view_.height, is_gray() ? 1 : 3}, depth_};
    for (float& depth : result.depth.values())
      depth = static_cast<float>(depth_factor / (2.0 * depth - 1 - depth_offset));
    for (int v = 0; v < view_.height; ++v)
      for (int u = 0; u < view_.width; ++u)
        for (int channel = 0; channel < result.pixels.channels(); ++channel)
          result.pixels.at(u, v, channel) = pixels_.at(u, v, channel);
    return result;
  }

 private:
  [[nodiscard]] bool is_gray() const { return config_.pixels == PixelKind::gray; }

  void draw(bool reads_depth) {
    const GLbitfield planes = GL_COLOR_BUFFER_BIT | (reads_depth ? GL_DEPTH_BUFFER_BIT : 0U);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target_);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    if (target_ != result_) {
      glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
      glBindFramebuffer(GL_DRAW_FRAMEBUFFER, result_);
      glBlitFramebuffer(0, 0, view_.width, view_.height, 0, 0, view_.width, view_.height, planes, GL_NEAREST);
      glBindFramebuffer(GL_READ_FRAMEBUFFER, result_);
    }
    glReadPixels(0, 0, view_.width, view_.height, is_gray() ? GL_RED : GL_RGBA, GL_UNSIGNED_BYTE,
                 pixels_.values().data());
    if (reads_depth)
      glReadPixels(0, 0, view_.width, view_.height, GL_DEPTH_COMPONENT, GL_FLOAT, depth_.values().data());
  }

  void set_uniforms(const Setting& setting) const {
    const Intrinsics& lens = view_.lens.intrinsics();
    const Light& light = setting.scene.light;
    const Eigen::Vector3f way = light_in_camera(setting);
    const auto place = [&](const char* name) { return glGetUniformLocation(program_, name); };
    // OpenGL's pixel centers have half-integer coordinates.
    glUniform4f(place("lens"), static_cast<float>(2 * lens.fx / view_.width),
                static_cast<float>(2 * lens.fy / view_.height),
                static_cast<float>((2 * lens.cx + 1) / view_.width - 1),
                static_cast<float>((2 * lens.cy + 1) / view_.height - 1));
    glUniform2f(place("depth"), static_cast<float>(depth_offset), static_cast<float>(depth_factor));
    glUniform3f(place("light"), way.x(), way.y(), way.z());
    glUniform2f(place("ambient_and_directional"), static_cast<float>(light.ambient),
                static_cast<float>(light.directional));
    glUniform1i(place("is_gray"), is_gray() ? 1 : 0);
  }

  void load(const PeerMesh& mesh) {
    GLuint array = 0;
    std::array<GLuint, 2> buffers = {};
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(2, buffers.data());
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.corners.size() * sizeof(Corner)),
                 mesh.corners.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    glBindVertexBuffer(0, buffers[0], 0, sizeof(Corner));
    constexpr std::array<GLuint, 3> offsets = {offsetof(Corner, position), offsetof(Corner, normal),
                                               offsetof(Corner, albedo)};
    for (GLuint i = 0; i < offsets.size(); ++i) {
      glVertexAttribFormat(i, 3, GL_FLOAT, GL_FALSE, offsets[i]);
      glVertexAttribBinding(i, 0);
      glEnableVertexAttribArray(i);
    }
    count_ = static_cast<GLsizei>(mesh.triangles.size());
  }

  [[nodiscard]] GLuint make_target(int samples) const {
    GLuint target = 0;
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    add_plane(GL_COLOR_ATTACHMENT0, is_gray() ? GL_R8 : GL_RGBA8, samples, view_);
    add_plane(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, samples, view_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("OpenGL: no such framebuffer");
    return target;
  }

  LlvmpipeConfig config_;
  View view_;
  EglContext context_;
  GLuint program_ = 0, target_ = 0, result_ = 0;
  GLsizei count_ = 0;
  Image<std::uint8_t> pixels_;
  Image<float> depth_;
};

}  // namespace

std::unique_ptr<Peer> llvmpipe_peer(const Setting& setting, LlvmpipeConfig config) {
  return std::make_unique<LlvmpipePeer>(setting, config);
}

}  // namespace flexura
