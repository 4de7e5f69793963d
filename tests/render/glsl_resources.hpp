// Counts what a shader text asks of a driver by the rules of GLSL ES 1.00.
//
// Why it exists: drivers of our test machines have room for everything, so nothing would notice a program that the
// weakest driver must refuse. Reads texts, needs no GL. Test code; pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lackwerk::test {

/// The text after its preprocessor: what #if leaves, macros of numbers replaced by them. Understands what our texts
/// use: #define NAME [number], #if with numbers, names, defined(), ! && || == != < > <= >= and parentheses; #ifdef,
/// #ifndef, #else, #endif.
[[nodiscard]] std::string preprocessed(std::string_view source);

struct ShaderVariable {
  std::string name;
  int columns = 1;  ///< 1 to 4; a mat4 is four rows of four
  int rows = 1;     ///< elements of an array, times four for a mat4
};

/// Variables of that storage ("uniform", "varying", "attribute") that a preprocessed text declares and uses anywhere,
/// in code that is never called too: that is what "static use" means. Samplers are left out.
[[nodiscard]] std::vector<ShaderVariable> used_variables(const std::string& text, std::string_view storage);
/// Samplers likewise.
[[nodiscard]] int used_samplers(const std::string& text);

/// Rows of four that they take, packed as appendix A.7 of the specification does.
[[nodiscard]] int packed_rows(std::vector<ShaderVariable> variables);

}  // namespace lackwerk::test
