// The "tensor file" container of the RGL material database: named arrays in one file.
//
// Why it exists: the bytes come from anywhere. This is the one place that believes nothing of them: after it, fields
// lie inside the file, apart from each other, and have the sizes they say. What the numbers mean is rgl_file.hpp's. The
// fields borrow the bytes: keep them. Pure function; any thread.
//
// Layout, little-endian (Dupuy & Jakob 2018, supplement): "tensor_file\0", u8 version 1, 0, u32 number of fields; per
// field u16 length of the name, the name, u16 dimensions, u8 type, u64 offset from the start, u64 per dimension.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace lackwerk::packs {

/// The types that are read; the container knows others, whose fields are kept but cannot be asked for.
enum class TensorType : std::uint8_t { bytes = 1, f32 = 10 };

struct Tensor {
  std::string name;
  std::uint8_t type = 0;
  std::vector<std::size_t> shape;  ///< at most 8 dimensions, the last one runs fastest
  std::size_t count = 0;           ///< product of the shape, > 0
  std::span<const std::uint8_t> bytes;

  /// `type` must be f32. Not aligned in the file: copied.
  [[nodiscard]] std::vector<float> floats() const;
};

class TensorFile {
 public:
  /// Checks the whole container. `file` names it in errors.
  [[nodiscard]] static Result<TensorFile> parse(std::span<const std::uint8_t> bytes, const std::string& file);

  /// Null where there is none.
  [[nodiscard]] const Tensor* find(std::string_view name) const;
  /// A field of this type and number of dimensions, or the error that says what is wrong with it.
  [[nodiscard]] Result<const Tensor*> need(std::string_view name, TensorType type, std::size_t dimensions) const;
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
  std::vector<Tensor> tensors_;
};

}  // namespace lackwerk::packs
