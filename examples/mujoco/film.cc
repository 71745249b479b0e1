// SPDX-License-Identifier: BSD-3-Clause
// ergocast-example-mujoco-film: simulates a scenario in one process and writes the pictures of a
// camera above the room. They go to the standard output as raw RGB, or one frame goes to a PPM
// file:
//   ergocast-example-mujoco-film examples/mujoco/discs.textproto discs 720 720 |
//     ffmpeg -f rawvideo -pixel_format rgb24 -video_size 720x720 -framerate 20 -i - film.webm
#include <EGL/egl.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "examples/mujoco/mujoco_physics.h"
#include "lab/simulation.h"
#include "plan/plan.h"
#include "scenario/scenario.h"

namespace ergocast::mujoco {
namespace {

/// An OpenGL context without a window.
bool open_egl() {
  setenv("EGL_PLATFORM", "surfaceless", 0);
  const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  EGLint major = 0, minor = 0, count = 0;
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_DEPTH_SIZE,
                           24,
                           EGL_NONE};
  EGLConfig config = nullptr;
  if (eglInitialize(display, &major, &minor) == EGL_FALSE ||
      eglBindAPI(EGL_OPENGL_API) == EGL_FALSE ||
      eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count < 1)
    return false;
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  return context != EGL_NO_CONTEXT &&
         eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE;
}

class Camera {
 public:
  Camera(const Box& domain, int width, int height) : view_{0, 0, width, height} {
    mjv_defaultCamera(&camera_);
    mjv_defaultOption(&option_);
    mjv_defaultScene(&scene_);
    mjr_defaultContext(&context_);
    const Eigen::Vector3d middle_m = domain.center_m();
    camera_.lookat[0] = middle_m.x();
    camera_.lookat[1] = middle_m.y() - 0.04 * domain.size_m.y();
    camera_.distance = 1.3 * domain.size_m.head<2>().maxCoeff();
    camera_.azimuth = 90;
    camera_.elevation = -65;
  }
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;
  ~Camera() { forget(); }

  /// The picture's pixels, from the upper left corner.
  std::vector<unsigned char> picture(const mjModel* model, mjData* data) {
    if (model != model_) look_at(model);
    mjv_updateScene(model, data, &option_, nullptr, &camera_, mjCAT_ALL, &scene_);
    mjr_render(view_, &scene_, &context_);
    const std::ptrdiff_t row = 3 * std::ptrdiff_t{view_.width};
    std::vector<unsigned char> pixels(static_cast<std::size_t>(row * view_.height)), upright;
    mjr_readPixels(pixels.data(), nullptr, view_, &context_);
    for (int y = view_.height - 1; y >= 0; --y) {
      const auto from = pixels.begin() + row * y;
      upright.insert(upright.end(), from, from + row);
    }
    return upright;
  }

 private:
  void look_at(const mjModel* model) {
    forget();
    model_ = model;
    mjv_makeScene(model, &scene_, 5000);
    mjr_makeContext(model, &context_, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
  }
  void forget() {
    if (model_ == nullptr) return;
    mjv_freeScene(&scene_);
    mjr_freeContext(&context_);
  }

  mjrRect view_;
  mjvCamera camera_{};
  mjvOption option_{};
  mjvScene scene_{};
  mjrContext context_{};
  const mjModel* model_ = nullptr;
};

struct Film {
  int width = 720, height = 720;
  std::string still;  ///< empty, or the PPM file that frame `still_tick` goes to
  int still_tick = 0;
};

class FilmedPhysics : public MujocoPhysics {
 public:
  FilmedPhysics(const Mission& mission, const RobotDesign& design, const Film& film)
      : MujocoPhysics(mission, design),
        film_(film),
        camera_(mission.domain, film.width, film.height) {}

  void pass_tick(std::span<PhysicalBody> bodies) override {
    MujocoPhysics::pass_tick(bodies);
    ++tick_;
    if (film_.still.empty()) {
      const auto frame = camera_.picture(model(), data());
      std::fwrite(frame.data(), 1, frame.size(), stdout);
    } else if (tick_ == film_.still_tick) {
      const auto frame = camera_.picture(model(), data());
      std::ofstream file(film_.still, std::ios::binary);
      file << "P6 " << film_.width << ' ' << film_.height << " 255\n";
      file.write(reinterpret_cast<const char*>(frame.data()),
                 static_cast<std::streamsize>(frame.size()));
    }
  }

 private:
  Film film_;
  Camera camera_;
  int tick_ = 0;
};

int film_mission(const Mission& mission, const RobotDesign& design, const Film& film) {
  std::ostringstream trajectory, metrics;
  lab::Simulation simulation(
      {.plan = encode_plan(mission),
       .physics = [&](const Mission& flown) -> Result<std::unique_ptr<Physics>> {
         return std::make_unique<FilmedPhysics>(flown, design, film);
       }},
      trajectory, metrics);
  simulation.run();
  std::fprintf(stderr, "%s\n", simulation.world().physics_summary().c_str());
  return 0;
}

bool read_whole(const char* text, int& number) {
  const char* const end = text + std::strlen(text);
  const auto [rest, error] = std::from_chars(text, end, number);
  return error == std::errc() && rest == end && number > 0;
}

int run(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s SCENARIO discs|quadrotors WIDTH HEIGHT [STILL.ppm TICK]\n",
                 argv[0]);
    return 2;
  }
  const auto loaded = Scenario::load(argv[1], {});
  if (!loaded) {
    for (const Problem& problem : loaded.error())
      std::fprintf(stderr, "%s\n", to_string(problem).c_str());
    return 2;
  }
  if (!open_egl()) {
    std::fprintf(stderr, "no OpenGL without a window: install libegl-mesa0 and libgl1-mesa-dri\n");
    return 3;
  }
  Film film;
  if (!read_whole(argv[3], film.width) || !read_whole(argv[4], film.height) ||
      (argc > 6 && !read_whole(argv[6], film.still_tick))) {
    std::fprintf(stderr, "%s: WIDTH, HEIGHT and TICK are whole numbers above 0\n", argv[0]);
    return 2;
  }
  if (argc > 6) film.still = argv[5];
  const bool rolls = std::strcmp(argv[2], "discs") == 0;
  return film_mission(loaded->mission(), rolls ? kDiscs : kQuadrotors, film);
}

}  // namespace
}  // namespace ergocast::mujoco

int main(int argc, char** argv) { return ergocast::mujoco::run(argc, argv); }
