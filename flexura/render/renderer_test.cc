// Heap allocations of the renderer and its shared state. This replaces the test program's operator new.
#include "flexura/render/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <thread>
#include <vector>

#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace {

std::atomic<int> allocations{0};

}  // namespace

// Not inlined: otherwise the compiler would report new and free as mismatched.
// Sanitizers have their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  void* place = std::malloc(size);
  if (place == nullptr) throw std::bad_alloc();
  return place;
}
[[gnu::noinline]] void operator delete(void* place) noexcept { std::free(place); }
[[gnu::noinline]] void operator delete(void* place, std::size_t /*size*/) noexcept { std::free(place); }
#endif

namespace flexura {
namespace {

// All kinds of bodies except a floor, above which the fast path would draw nothing.
Scene some_scene(TestRandom& random, const BentArm& bent) {
  Scene scene = crowded_scene(random, bent.backbone());
  scene.obstacles.pop_back();
  return scene;
}

TEST(Renderer, AllocatesNothingForASecondPicture) {
  if (one_case_of != 1) GTEST_SKIP() << "sanitizers allocate for themselves";
  for_random_cases(4, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.003, 0.003);
    Scene scene = some_scene(random, bent);
    const View view = random_view_of(random, bent.backbone());
    for (const bool is_exact : {true, false}) {
      scene.light.shadow = is_exact ? 0.5 : 0;
      Renderer renderer;
      LightImage picture;
      renderer.render(scene, view, PixelKind::gray, picture, is_exact);
      const int before = allocations;
      renderer.render(scene, view, PixelKind::gray, picture, is_exact);
      EXPECT_EQ(allocations - before, 0) << is_exact;
    }
  });
}

// For a moving arm, once its pictures have reached their largest content.
TEST(Renderer, AllocatesHardlyAnythingForAnArmThatMoves) {
  if (one_case_of != 1) GTEST_SKIP() << "forty exact pictures take minutes in a sanitized build";
  TestRandom random(1);
  BentArm bent = random_bent_arm(random, 0.003, 0.003);
  const View view = random_view_of(random, bent.backbone());
  std::vector<Scene> scenes;
  for (int i = 0; i < 40; ++i) {
    for (Eigen::Vector2d& bend : bent.state.bends) bend += random.vector<2>(-0.05, 0.05);
    TestRandom same(2);
    scenes.push_back(some_scene(same, bent));
  }
  Renderer renderer;
  LightImage picture;
  int before = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (i == 20) before = allocations;
    renderer.render(scenes[i], view, PixelKind::gray, picture, true);
  }
  EXPECT_LE(allocations - before, 4);
}

// The stored data must match the lens and size of the present picture.
TEST(Renderer, DrawsTheSameWhateverWasDrawnBefore) {
  TestRandom random(3);
  const BentArm bent = random_bent_arm(random, 0.003, 0.003);
  Scene scene;
  scene.arm.tube = tube_of(bent.backbone());
  scene.background = {0.9, 0.9, 0.9};
  View view = random_view_of(random, bent.backbone());
  view = pinhole_view(view.X_WC, 24, 18, 30);
  Renderer renderer;
  LightImage picture, alone;
  const auto expect_as_alone = [&](const char* what) {
    for (const bool is_exact : {true, false}) {
      renderer.render(scene, view, PixelKind::gray, picture, is_exact);
      Renderer().render(scene, view, PixelKind::gray, alone, is_exact);
      EXPECT_EQ(picture.light, alone.light) << what << ' ' << is_exact;
    }
  };
  expect_as_alone("the first");
  Intrinsics intrinsics = view.lens.intrinsics();
  for (const std::size_t k : {std::size_t{0}, std::size_t{2}, std::size_t{4}}) {
    intrinsics.distortion[k] += 0.1, view.lens = Lens(intrinsics);
    expect_as_alone("another distortion");
  }
  for (double* number : {&intrinsics.fx, &intrinsics.fy, &intrinsics.cx, &intrinsics.cy}) {
    *number += 3, view.lens = Lens(intrinsics);
    expect_as_alone("another pinhole");
  }
  view.width = 18, view.height = 24;
  expect_as_alone("another size");
  view.X_WC.position += 0.1 * view.X_WC.rotation.col(0);
  expect_as_alone("another place");
}

TEST(Renderer, DrawsTheSameInSeveralThreadsAtOnce) {
  for (const bool is_exact : {true, false}) {
    TestRandom random(5);
    const BentArm bent = random_bent_arm(random, 0.003, 0.003);
    std::vector<Scene> scenes;
    std::vector<View> views;
    for (int i = 0; i < (one_case_of == 1 ? 4 : 1); ++i) {
      scenes.push_back(some_scene(random, bent));
      views.push_back(random_view_of(random, bent.backbone()));
    }
    const auto draw_all = [&](std::vector<LightImage>& pictures) {
      Renderer renderer;
      pictures.resize(scenes.size());
      for (std::size_t i = 0; i < scenes.size(); ++i)
        renderer.render(scenes[i], views[i], PixelKind::color, pictures[i], is_exact);
    };
    std::vector<LightImage> alone;
    draw_all(alone);
    std::vector<std::vector<LightImage>> together(3);
    std::vector<std::thread> threads;
    threads.reserve(together.size());
    for (auto& pictures : together) threads.emplace_back([&] { draw_all(pictures); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& pictures : together) {
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        EXPECT_EQ(pictures[i].light, alone[i].light);
        EXPECT_EQ(pictures[i].depth, alone[i].depth);
      }
    }
  }
}

}  // namespace
}  // namespace flexura
