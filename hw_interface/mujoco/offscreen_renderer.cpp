#include "hw_interface/mujoco/offscreen_renderer.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <cstdlib>
#include <utility>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace wex {
namespace {

constexpr int kMaxGeoms = 2000;

/// A current OpenGL context of one of the two kinds.
class GlContext {
 public:
  virtual ~GlContext() = default;
  virtual bool make_current() = 0;
  virtual void release() = 0;
};

template <typename Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

class EglContext final : public GlContext {
 public:
  static std::unique_ptr<GlContext> create() {
    void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_GLOBAL);
    if (!library) return nullptr;
    const auto get_display =
        symbol<decltype(&eglGetPlatformDisplay)>(library, "eglGetPlatformDisplay");
    const auto initialize = symbol<decltype(&eglInitialize)>(library, "eglInitialize");
    const auto bind_api = symbol<decltype(&eglBindAPI)>(library, "eglBindAPI");
    const auto choose_config = symbol<decltype(&eglChooseConfig)>(library, "eglChooseConfig");
    const auto create_context = symbol<decltype(&eglCreateContext)>(library, "eglCreateContext");
    auto context = std::unique_ptr<EglContext>(new EglContext);
    context->make_current_ = symbol<decltype(&eglMakeCurrent)>(library, "eglMakeCurrent");
    context->destroy_ = symbol<decltype(&eglDestroyContext)>(library, "eglDestroyContext");
    if (!get_display || !initialize || !bind_api || !choose_config || !create_context ||
        !context->make_current_ || !context->destroy_) {
      return nullptr;
    }
    context->display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    if (context->display_ == EGL_NO_DISPLAY || !initialize(context->display_, nullptr, nullptr) ||
        !bind_api(EGL_OPENGL_API)) {
      return nullptr;
    }
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (!choose_config(context->display_, wanted, &config, 1, &found) || found < 1) return nullptr;
    context->context_ = create_context(context->display_, config, EGL_NO_CONTEXT, nullptr);
    if (context->context_ == EGL_NO_CONTEXT || !context->make_current()) return nullptr;
    return context;
  }

  ~EglContext() override {
    if (context_ == EGL_NO_CONTEXT) return;
    release();
    destroy_(display_, context_);
  }
  bool make_current() override {
    return make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
  }
  void release() override {
    make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

 private:
  EglContext() = default;
  EGLDisplay display_ = EGL_NO_DISPLAY;  // shared by the process, never terminated
  ::EGLContext context_ = EGL_NO_CONTEXT;
  decltype(&eglMakeCurrent) make_current_ = nullptr;
  decltype(&eglDestroyContext) destroy_ = nullptr;
};

class OsMesaContext final : public GlContext {
 public:
  static std::unique_ptr<GlContext> create() {
    void* library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_GLOBAL);
    if (!library) return nullptr;
    auto context = std::unique_ptr<OsMesaContext>(new OsMesaContext);
    const auto create_context = symbol<CreateContext>(library, "OSMesaCreateContextExt");
    context->make_current_ = symbol<MakeCurrent>(library, "OSMesaMakeCurrent");
    context->destroy_ = symbol<DestroyContext>(library, "OSMesaDestroyContext");
    if (!create_context || !context->make_current_ || !context->destroy_) return nullptr;
    context->context_ = create_context(kRgba, kDepthBits, kStencilBits, 0, nullptr);
    if (!context->context_ || !context->make_current()) return nullptr;
    return context;
  }

  ~OsMesaContext() override {
    if (context_) destroy_(context_);
  }
  bool make_current() override {
    return make_current_(context_, buffer_.data(), kUnsignedByte, kBufferSide_px, kBufferSide_px) !=
           0;
  }
  void release() override {}

 private:
  // The ABI of GL/osmesa.h, which is not installed everywhere.
  using CreateContext = void* (*)(unsigned, int, int, int, void*);
  using MakeCurrent = unsigned char (*)(void*, void*, unsigned, int, int);
  using DestroyContext = void (*)(void*);
  static constexpr unsigned kRgba = 0x1908, kUnsignedByte = 0x1401;
  static constexpr int kDepthBits = 24, kStencilBits = 8,
                       kBufferSide_px = 16;  // unused: drawn off screen

  OsMesaContext() = default;
  void* context_ = nullptr;
  MakeCurrent make_current_ = nullptr;
  DestroyContext destroy_ = nullptr;
  std::vector<unsigned char> buffer_ =
      std::vector<unsigned char>(4 * kBufferSide_px * kBufferSide_px);
};

}  // namespace

struct OffscreenRenderer::Impl {
  std::unique_ptr<GlContext> gl;
  mjvScene scene{};
  mjrContext context{};
  mjvOption option{};

  ~Impl() {
    gl->make_current();
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
    gl->release();
  }
};

OffscreenRenderer::OffscreenRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OffscreenRenderer::~OffscreenRenderer() = default;

Result<std::unique_ptr<OffscreenRenderer>> OffscreenRenderer::create(const mjModel* model) {
  const char* loader = "egl";
  std::unique_ptr<GlContext> gl = EglContext::create();
  if (!gl) {
    loader = "osmesa";
    gl = OsMesaContext::create();
  }
  if (!gl) {
    return fail(ErrorCode::kInternal,
                "rendering needs libEGL.so.1 or libOSMesa.so.8, neither gives a context "
                "(Debian: apt-get install libegl1 libgl1-mesa-dri)");
  }
  setenv("MUJOCO_GL", loader, 1);  // which loader MuJoCo asks for OpenGL's functions
  auto impl = std::make_unique<Impl>();
  impl->gl = std::move(gl);
  mjv_defaultOption(&impl->option);
  mjv_defaultScene(&impl->scene);
  mjr_defaultContext(&impl->context);
  mjv_makeScene(model, &impl->scene, kMaxGeoms);
  mjr_makeContext(model, &impl->context, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &impl->context);
  if (impl->context.currentBuffer != mjFB_OFFSCREEN) {
    return fail(ErrorCode::kInternal, "MuJoCo cannot draw off screen with this graphics library");
  }
  impl->gl->release();
  return std::unique_ptr<OffscreenRenderer>(new OffscreenRenderer(std::move(impl)));
}

Result<void> OffscreenRenderer::draw(const mjModel* model, mjData* data, const mjvCamera& camera,
                                     const std::string& png_file, int width_px, int height_px) {
  WEX_EXPECTS(width_px > 0 && height_px > 0);
  if (!impl_->gl->make_current()) {
    return fail(ErrorCode::kInternal, "the graphics library refuses its own context");
  }
  if (impl_->context.offWidth != width_px || impl_->context.offHeight != height_px) {
    mjr_resizeOffscreen(width_px, height_px, &impl_->context);
  }
  mjvCamera view = camera;
  mjv_updateScene(model, data, &impl_->option, nullptr, &view, mjCAT_ALL, &impl_->scene);
  const mjrRect viewport{0, 0, width_px, height_px};
  mjr_render(viewport, &impl_->scene, &impl_->context);
  std::vector<unsigned char> pixels(3UL * width_px * height_px);
  mjr_readPixels(pixels.data(), nullptr, viewport, &impl_->context);
  impl_->gl->release();
  // OpenGL's first row is the lowest, the file's the highest.
  const int stride = 3 * width_px;
  const unsigned char* top = pixels.data() + static_cast<std::size_t>(stride) * (height_px - 1);
  if (stbi_write_png(png_file.c_str(), width_px, height_px, 3, top, -stride) == 0) {
    return fail(ErrorCode::kBadInput, png_file + ": cannot be written");
  }
  return {};
}

}  // namespace wex
