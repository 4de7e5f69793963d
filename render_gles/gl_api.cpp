#include "render_gles/gl_api.hpp"

#include "core/check.hpp"

namespace lackwerk::gles {

Result<GlApi> GlApi::load(const GetProc& get_proc, const std::string& backend) {
  GlApi gl;
  std::string missing;
  const auto find = [&](auto& slot, const char* name) {
    void* address = get_proc(name);
    if (address == nullptr) missing += std::string(missing.empty() ? "" : ", ") + name;
    slot = reinterpret_cast<std::remove_reference_t<decltype(slot)>>(address);
  };
  find(gl.ActiveTexture, "glActiveTexture");
  find(gl.AttachShader, "glAttachShader");
  find(gl.BindAttribLocation, "glBindAttribLocation");
  find(gl.BindBuffer, "glBindBuffer");
  find(gl.BindFramebuffer, "glBindFramebuffer");
  find(gl.BindRenderbuffer, "glBindRenderbuffer");
  find(gl.BindTexture, "glBindTexture");
  find(gl.BlendFunc, "glBlendFunc");
  find(gl.BlendFuncSeparate, "glBlendFuncSeparate");
  find(gl.BufferData, "glBufferData");
  find(gl.CheckFramebufferStatus, "glCheckFramebufferStatus");
  find(gl.Clear, "glClear");
  find(gl.ClearColor, "glClearColor");
  find(gl.ClearDepthf, "glClearDepthf");
  find(gl.ColorMask, "glColorMask");
  find(gl.CompileShader, "glCompileShader");
  find(gl.CopyTexSubImage2D, "glCopyTexSubImage2D");
  find(gl.CreateProgram, "glCreateProgram");
  find(gl.CreateShader, "glCreateShader");
  find(gl.CullFace, "glCullFace");
  find(gl.DeleteBuffers, "glDeleteBuffers");
  find(gl.DeleteFramebuffers, "glDeleteFramebuffers");
  find(gl.DeleteProgram, "glDeleteProgram");
  find(gl.DeleteRenderbuffers, "glDeleteRenderbuffers");
  find(gl.DeleteShader, "glDeleteShader");
  find(gl.DeleteTextures, "glDeleteTextures");
  find(gl.DepthFunc, "glDepthFunc");
  find(gl.DepthMask, "glDepthMask");
  find(gl.Disable, "glDisable");
  find(gl.DisableVertexAttribArray, "glDisableVertexAttribArray");
  find(gl.DrawArrays, "glDrawArrays");
  find(gl.DrawElements, "glDrawElements");
  find(gl.Enable, "glEnable");
  find(gl.EnableVertexAttribArray, "glEnableVertexAttribArray");
  find(gl.Finish, "glFinish");
  find(gl.Flush, "glFlush");
  find(gl.FramebufferRenderbuffer, "glFramebufferRenderbuffer");
  find(gl.FramebufferTexture2D, "glFramebufferTexture2D");
  find(gl.FrontFace, "glFrontFace");
  find(gl.GenBuffers, "glGenBuffers");
  find(gl.GenFramebuffers, "glGenFramebuffers");
  find(gl.GenRenderbuffers, "glGenRenderbuffers");
  find(gl.GenTextures, "glGenTextures");
  find(gl.GetActiveUniform, "glGetActiveUniform");
  find(gl.GetAttribLocation, "glGetAttribLocation");
  find(gl.GetError, "glGetError");
  find(gl.GetIntegerv, "glGetIntegerv");
  find(gl.GetProgramInfoLog, "glGetProgramInfoLog");
  find(gl.GetProgramiv, "glGetProgramiv");
  find(gl.GetShaderInfoLog, "glGetShaderInfoLog");
  find(gl.GetShaderPrecisionFormat, "glGetShaderPrecisionFormat");
  find(gl.GetShaderiv, "glGetShaderiv");
  find(gl.GetString, "glGetString");
  find(gl.GetUniformLocation, "glGetUniformLocation");
  find(gl.LinkProgram, "glLinkProgram");
  find(gl.PixelStorei, "glPixelStorei");
  find(gl.ReadPixels, "glReadPixels");
  find(gl.RenderbufferStorage, "glRenderbufferStorage");
  find(gl.Scissor, "glScissor");
  find(gl.ShaderSource, "glShaderSource");
  find(gl.TexImage2D, "glTexImage2D");
  find(gl.TexParameteri, "glTexParameteri");
  find(gl.TexSubImage2D, "glTexSubImage2D");
  find(gl.Uniform1f, "glUniform1f");
  find(gl.Uniform1fv, "glUniform1fv");
  find(gl.Uniform1i, "glUniform1i");
  find(gl.Uniform2f, "glUniform2f");
  find(gl.Uniform2fv, "glUniform2fv");
  find(gl.Uniform3f, "glUniform3f");
  find(gl.Uniform3fv, "glUniform3fv");
  find(gl.Uniform4f, "glUniform4f");
  find(gl.Uniform4fv, "glUniform4fv");
  find(gl.UniformMatrix3fv, "glUniformMatrix3fv");
  find(gl.UniformMatrix4fv, "glUniformMatrix4fv");
  find(gl.UseProgram, "glUseProgram");
  find(gl.VertexAttrib1f, "glVertexAttrib1f");
  find(gl.VertexAttrib4f, "glVertexAttrib4f");
  find(gl.VertexAttribPointer, "glVertexAttribPointer");
  find(gl.Viewport, "glViewport");
  if (!missing.empty())
    return fail(backend, "OpenGL ES 2.0", "missing " + missing, "use a driver that offers OpenGL ES 2.0 or better");
  return gl;
}

const char* gl_error_name(GLenum code) {
  switch (code) {
    case GL_NO_ERROR:
      return "GL_NO_ERROR";
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    default:
      return "unknown GL error";
  }
}

void check_gl(const GlApi& gl, const char* where) {
  const GLenum code = gl.GetError();
  check_equal(std::string_view(gl_error_name(code)), std::string_view("GL_NO_ERROR"), where);
}

}  // namespace lackwerk::gles
