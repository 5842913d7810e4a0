// SPDX-License-Identifier: MIT
// Headless contexts through EGL's device and surfaceless platforms, and the caller's context through EGL or GLX.
// Displays are never terminated: EGL shares them with the rest of the process.
#include "device/gl/gl_context.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "device/device.h"
#include "device/gl/callers_context.h"
#include "log.h"

namespace talus::engine {
namespace {

std::string egl_error() {
    switch (const EGLint code = eglGetError()) {
    case EGL_SUCCESS:
        return "no reason given";
    case EGL_NOT_INITIALIZED:
        return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
        return "EGL_BAD_ACCESS: it is current on another thread (World::make_gl_current leaves it there), or a "
               "context of another API (GLX) is current on this one";
    case EGL_BAD_ALLOC:
        return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
        return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
        return "EGL_BAD_CONFIG";
    case EGL_BAD_MATCH:
        return "EGL_BAD_MATCH: no OpenGL 4.5 core profile";
    case EGL_BAD_PARAMETER:
        return "EGL_BAD_PARAMETER";
    case EGL_CONTEXT_LOST:
        return "EGL_CONTEXT_LOST";
    default:
        return "EGL error " + std::to_string(code);
    }
}

void* current_egl_context() {
    return eglGetCurrentContext();
}

/// The function of a GLX library that the caller has loaded; asking so keeps X11 out of the library's needs.
void* (*find_glx_query())() {
    for (const char* library : {"libGLX.so.0", "libGL.so.1"}) {
        if (void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD)) {
            void* symbol = dlsym(handle, "glXGetCurrentContext");
            dlclose(handle);
            if (symbol != nullptr) return reinterpret_cast<void* (*)()>(symbol);
        }
    }
    return nullptr;
}

LogLevel level_of(GLenum severity) {
    switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH:
        return LogLevel::Error;
    case GL_DEBUG_SEVERITY_MEDIUM:
        return LogLevel::Warning;
    case GL_DEBUG_SEVERITY_LOW:
        return LogLevel::Info;
    default:
        return LogLevel::Debug;
    }
}

void GLAPIENTRY log_debug_message(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                                  const GLchar* message, const void* context) {
    // What the compiler has to say comes as an Error, with the lines of the source files.
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
    if (type == GL_DEBUG_TYPE_PUSH_GROUP || type == GL_DEBUG_TYPE_POP_GROUP) return;
    const auto size = length < 0 ? std::strlen(message) : static_cast<std::size_t>(length);
    log(level_of(severity), std::string("OpenGL (") + static_cast<const OpenGlContext*>(context)->activity +
                                "): " + std::string(message, size));
}

bool debug_wanted() {
    const char* value = std::getenv("TALUS_GL_DEBUG");
    return value != nullptr && std::strcmp(value, "1") == 0;
}

std::string gl_string(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text != nullptr ? text : "unknown";
}

} // namespace

/// A display that may give a context.
struct EglCandidate {
    std::string label;
    EGLDisplay display = EGL_NO_DISPLAY;

    std::unique_ptr<OpenGlContext> open(bool debug) const;
};

/// Leaves the new context current. Throws Error with the reason alone.
std::unique_ptr<OpenGlContext> EglCandidate::open(bool debug) const {
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
        throw Error("its display cannot be opened (" + egl_error() + ")");
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) throw Error("it has no desktop OpenGL");

    // A pbuffer of one pixel stands in where contexts need a surface to be current on.
    const bool surfaceless = epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context");
    const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                       surfaceless ? 0 : EGL_PBUFFER_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint config_count = 0;
    if (eglChooseConfig(display, wanted.data(), &config, 1, &config_count) == EGL_FALSE || config_count == 0)
        throw Error("it offers no configuration for desktop OpenGL");

    std::unique_ptr<OpenGlContext> opened(new OpenGlContext);
    opened->own_ = true;
    opened->debug_ = debug || debug_wanted();
    opened->display_ = display;
    opened->query_current_ = current_egl_context;
    if (!surfaceless) {
        const std::array<EGLint, 5> pixel{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        opened->surface_ = eglCreatePbufferSurface(display, config, pixel.data());
        if (opened->surface_ == EGL_NO_SURFACE) throw Error("it gives no off-screen surface (" + egl_error() + ")");
    }
    const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_CONTEXT_OPENGL_DEBUG,
                                           opened->debug_ ? EGL_TRUE : EGL_FALSE,
                                           EGL_NONE};
    opened->context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (opened->context_ == EGL_NO_CONTEXT) throw Error("it gives no OpenGL 4.5 core context (" + egl_error() + ")");
    opened->make_current();
    opened->describe();
    if (opened->debug_) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(log_debug_message, opened.get());
    }
    return opened;
}

namespace {

bool has_client_extension(const char* name) {
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

std::vector<EglCandidate> device_candidates() {
    std::vector<EglCandidate> candidates;
    if (!has_client_extension("EGL_EXT_platform_device") ||
        !(has_client_extension("EGL_EXT_device_enumeration") || has_client_extension("EGL_EXT_device_base")))
        return candidates;
    EGLint count = 0;
    eglQueryDevicesEXT(0, nullptr, &count);
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    eglQueryDevicesEXT(count, devices.data(), &count);
    for (EGLint i = 0; i < count; ++i) {
        candidates.push_back(
            {"EGL device " + std::to_string(i),
             eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr)});
    }
    return candidates;
}

std::vector<EglCandidate> surfaceless_candidates() {
    if (!has_client_extension("EGL_MESA_platform_surfaceless")) return {};
    return {{"EGL surfaceless platform",
             eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)}};
}

constexpr const char* k_no_egl = "libEGL.so.1 cannot be loaded (Debian: apt install libegl1 libgl1-mesa-dri)";
constexpr const char* k_no_platform = "EGL has no driver, or one without both the device platform "
                                      "(EGL_EXT_platform_device) and the surfaceless one "
                                      "(EGL_MESA_platform_surfaceless)";

} // namespace

std::unique_ptr<OpenGlContext> OpenGlContext::own(bool debug) {
    const std::string refused = "no OpenGL 4.5 context without a window: ";
    if (!epoxy_has_egl()) throw Error(refused + k_no_egl);

    const CallersContext callers;
    std::unique_ptr<OpenGlContext> in_software;
    std::string tried;
    for (const auto& candidates : {device_candidates(), surfaceless_candidates()}) {
        for (const EglCandidate& candidate : candidates) {
            try {
                std::unique_ptr<OpenGlContext> opened = candidate.open(debug);
                if (!opened->is_software()) {
                    opened->why_ = candidate.label + ", the first OpenGL 4.5 renderer in hardware";
                    return opened;
                }
                if (!in_software) {
                    opened->why_ = candidate.label + ", no OpenGL 4.5 renderer in hardware was found";
                    in_software = std::move(opened);
                }
            } catch (const Error& error) {
                tried += (tried.empty() ? "" : "; ") + candidate.label + ": " + error.what();
            }
        }
    }
    if (in_software) return in_software;
    if (tried.empty()) tried = k_no_platform;
    throw Error(refused + tried +
                ". A GPU needs its driver's EGL library; Mesa's renderer in software comes with "
                "Debian's packages libegl1 and libgl1-mesa-dri");
}

std::unique_ptr<OpenGlContext> OpenGlContext::current() {
    std::unique_ptr<OpenGlContext> found(new OpenGlContext);
    if (epoxy_has_egl() && current_egl_context() != nullptr)
        found->query_current_ = current_egl_context;
    else if (auto* glx_query = find_glx_query(); glx_query != nullptr && glx_query() != nullptr)
        found->query_current_ = glx_query;
    else
        throw Error("GlContext::Current: no OpenGL context is current on this thread; make the renderer's context "
                    "current before making the world, or use GlContext::Own");
    found->context_ = found->query_current_();
    if (!epoxy_is_desktop_gl() || epoxy_gl_version() < 45)
        throw Error("GlContext::Current: the current context is '" + gl_string(GL_VERSION) +
                    "'; desktop OpenGL 4.5 or later is needed");
    found->describe();
    found->why_ = "the caller's context";
    return found;
}

OpenGlContext::~OpenGlContext() {
    if (!own_) return;
    if (context_ != nullptr) {
        if (eglGetCurrentContext() == context_)
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
    if (surface_ != nullptr) eglDestroySurface(display_, surface_);
}

void OpenGlContext::make_current() {
    if (query_current_() == context_) return;
    if (!own_)
        throw Error(
            "the OpenGL context that the world was made with (GlContext::Current) is not current on this thread; "
            "make it current before each call on the world");
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(display_, surface_, surface_, context_) == EGL_FALSE)
        throw Error("the world's own OpenGL context cannot be made current (" + egl_error() + ")");
}

void OpenGlContext::describe() {
    renderer_ = gl_string(GL_RENDERER);
    driver_ = "OpenGL " + gl_string(GL_VERSION) + ", " + gl_string(GL_VENDOR);
}

DeviceInfo OpenGlContext::info() const {
    return {.kind = DeviceKind::Gpu,
            .name = renderer_,
            .driver = driver_,
            .why = why_,
            .threads = 0,
            .in_software = is_software()};
}

bool OpenGlContext::is_software() const noexcept {
    for (const char* name :
         {"llvmpipe", "softpipe", "swrast", "SWR", "lavapipe", "SwiftShader", "Software Rasterizer"}) {
        if (renderer_.find(name) != std::string::npos) return true;
    }
    return false;
}

std::vector<DeviceInfo> probe_gl() {
    std::vector<DeviceInfo> probes;
    const auto refuse = [&probes](const std::string& why) {
        DeviceInfo& none = probes.emplace_back();
        none.kind = DeviceKind::Gpu;
        none.why = why;
    };
    if (!epoxy_has_egl()) {
        refuse(k_no_egl);
        return probes;
    }
    const CallersContext callers;
    const std::vector<EglCandidate> last = surfaceless_candidates();
    const EGLDisplay surfaceless = last.empty() ? EGL_NO_DISPLAY : last.front().display;
    for (const auto& candidates : {device_candidates(), last}) {
        for (const EglCandidate& candidate : candidates) {
            try {
                const auto opened = candidate.open(false);
                // The surfaceless platform mostly shows one of the devices again.
                const bool again = candidate.display == surfaceless &&
                                   std::any_of(probes.begin(), probes.end(), [&](const DeviceInfo& probe) {
                                       return probe.name == opened->renderer();
                                   });
                if (again) continue;
                probes.push_back(opened->info());
                probes.back().why = candidate.label;
            } catch (const Error& error) {
                refuse(candidate.label + ": " + error.what());
            }
        }
    }
    if (probes.empty()) refuse(k_no_platform);
    // The one that would be taken comes first, those that cannot be used last.
    std::stable_sort(probes.begin(), probes.end(), [](const DeviceInfo& a, const DeviceInfo& b) {
        const auto rank = [](const DeviceInfo& probe) { return probe.name.empty() ? 2 : probe.in_software ? 1 : 0; };
        return rank(a) < rank(b);
    });
    return probes;
}

} // namespace talus::engine
