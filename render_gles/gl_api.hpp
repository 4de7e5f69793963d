// The OpenGL ES 2.0 entry points this renderer calls, as one value.
//
// Why it exists: an EGL and an OSMesa context live in one process, and each brings its own functions. Nothing links
// libGLESv2: a context loads its own table. Members carry GL's names without the "gl", and GL's documentation is
// theirs. A value (copy it freely); its functions belong to the thread on which its context is current.
#pragma once

// The header's own prototypes would tempt callers to link against one library.
#define GL_GLES_PROTOTYPES 0
#include <GLES2/gl2.h>

#include <functional>
#include <string>

#include "core/error.hpp"

namespace lackwerk::gles {

/// Finds an entry point by its full name ("glClear"); null where there is none.
using GetProc = std::function<void*(const char* name)>;

struct GlApi {
  PFNGLACTIVETEXTUREPROC ActiveTexture = nullptr;
  PFNGLATTACHSHADERPROC AttachShader = nullptr;
  PFNGLBINDATTRIBLOCATIONPROC BindAttribLocation = nullptr;
  PFNGLBINDBUFFERPROC BindBuffer = nullptr;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = nullptr;
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer = nullptr;
  PFNGLBINDTEXTUREPROC BindTexture = nullptr;
  PFNGLBLENDFUNCPROC BlendFunc = nullptr;
  PFNGLBLENDFUNCSEPARATEPROC BlendFuncSeparate = nullptr;
  PFNGLBUFFERDATAPROC BufferData = nullptr;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus = nullptr;
  PFNGLCLEARPROC Clear = nullptr;
  PFNGLCLEARCOLORPROC ClearColor = nullptr;
  PFNGLCLEARDEPTHFPROC ClearDepthf = nullptr;
  PFNGLCOLORMASKPROC ColorMask = nullptr;
  PFNGLCOMPILESHADERPROC CompileShader = nullptr;
  PFNGLCOPYTEXSUBIMAGE2DPROC CopyTexSubImage2D = nullptr;
  PFNGLCREATEPROGRAMPROC CreateProgram = nullptr;
  PFNGLCREATESHADERPROC CreateShader = nullptr;
  PFNGLCULLFACEPROC CullFace = nullptr;
  PFNGLDELETEBUFFERSPROC DeleteBuffers = nullptr;
  PFNGLDELETEFRAMEBUFFERSPROC DeleteFramebuffers = nullptr;
  PFNGLDELETEPROGRAMPROC DeleteProgram = nullptr;
  PFNGLDELETERENDERBUFFERSPROC DeleteRenderbuffers = nullptr;
  PFNGLDELETESHADERPROC DeleteShader = nullptr;
  PFNGLDELETETEXTURESPROC DeleteTextures = nullptr;
  PFNGLDEPTHFUNCPROC DepthFunc = nullptr;
  PFNGLDEPTHMASKPROC DepthMask = nullptr;
  PFNGLDISABLEPROC Disable = nullptr;
  PFNGLDISABLEVERTEXATTRIBARRAYPROC DisableVertexAttribArray = nullptr;
  PFNGLDRAWARRAYSPROC DrawArrays = nullptr;
  PFNGLDRAWELEMENTSPROC DrawElements = nullptr;
  PFNGLENABLEPROC Enable = nullptr;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray = nullptr;
  PFNGLFINISHPROC Finish = nullptr;
  PFNGLFLUSHPROC Flush = nullptr;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer = nullptr;
  PFNGLFRAMEBUFFERTEXTURE2DPROC FramebufferTexture2D = nullptr;
  PFNGLFRONTFACEPROC FrontFace = nullptr;
  PFNGLGENBUFFERSPROC GenBuffers = nullptr;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers = nullptr;
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers = nullptr;
  PFNGLGENTEXTURESPROC GenTextures = nullptr;
  PFNGLGETACTIVEUNIFORMPROC GetActiveUniform = nullptr;
  PFNGLGETATTRIBLOCATIONPROC GetAttribLocation = nullptr;
  PFNGLGETERRORPROC GetError = nullptr;
  PFNGLGETINTEGERVPROC GetIntegerv = nullptr;
  PFNGLGETPROGRAMINFOLOGPROC GetProgramInfoLog = nullptr;
  PFNGLGETPROGRAMIVPROC GetProgramiv = nullptr;
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = nullptr;
  PFNGLGETSHADERPRECISIONFORMATPROC GetShaderPrecisionFormat = nullptr;
  PFNGLGETSHADERIVPROC GetShaderiv = nullptr;
  PFNGLGETSTRINGPROC GetString = nullptr;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = nullptr;
  PFNGLLINKPROGRAMPROC LinkProgram = nullptr;
  PFNGLPIXELSTOREIPROC PixelStorei = nullptr;
  PFNGLREADPIXELSPROC ReadPixels = nullptr;
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage = nullptr;
  PFNGLSCISSORPROC Scissor = nullptr;
  PFNGLSHADERSOURCEPROC ShaderSource = nullptr;
  PFNGLTEXIMAGE2DPROC TexImage2D = nullptr;
  PFNGLTEXPARAMETERIPROC TexParameteri = nullptr;
  PFNGLTEXSUBIMAGE2DPROC TexSubImage2D = nullptr;
  PFNGLUNIFORM1FPROC Uniform1f = nullptr;
  PFNGLUNIFORM1FVPROC Uniform1fv = nullptr;
  PFNGLUNIFORM1IPROC Uniform1i = nullptr;
  PFNGLUNIFORM2FPROC Uniform2f = nullptr;
  PFNGLUNIFORM2FVPROC Uniform2fv = nullptr;
  PFNGLUNIFORM3FPROC Uniform3f = nullptr;
  PFNGLUNIFORM3FVPROC Uniform3fv = nullptr;
  PFNGLUNIFORM4FPROC Uniform4f = nullptr;
  PFNGLUNIFORM4FVPROC Uniform4fv = nullptr;
  PFNGLUNIFORMMATRIX3FVPROC UniformMatrix3fv = nullptr;
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv = nullptr;
  PFNGLUSEPROGRAMPROC UseProgram = nullptr;
  PFNGLVERTEXATTRIB1FPROC VertexAttrib1f = nullptr;
  PFNGLVERTEXATTRIB4FPROC VertexAttrib4f = nullptr;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer = nullptr;
  PFNGLVIEWPORTPROC Viewport = nullptr;

  /// Loads every member. The context it belongs to must be current. Error: names `backend` and the missing functions.
  [[nodiscard]] static Result<GlApi> load(const GetProc& get_proc, const std::string& backend);
};

/// A GL error code by its name, for messages.
[[nodiscard]] const char* gl_error_name(GLenum code);

/// Aborts if GL has recorded an error: all calls are ours, so one is a broken invariant. `where` is printed with it.
/// Waits for nothing, but is not free: once a frame, not once a call.
void check_gl(const GlApi& gl, const char* where);

}  // namespace lackwerk::gles
