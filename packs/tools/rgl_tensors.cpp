#include "packs/tools/rgl_tensors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace lackwerk::packs {
namespace {

constexpr std::string_view magic{"tensor_file\0", 12};
constexpr std::size_t max_fields = 64;     ///< real files have 11 to 13
constexpr std::size_t max_name = 64;       ///< the longest real one, "description", has 11
constexpr std::size_t max_dimensions = 8;  ///< real ones have up to 5
constexpr const char* again = "download the file again";

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in the file");

/// Takes numbers from the front; never reads beyond the end.
class Cursor {
 public:
  explicit Cursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  [[nodiscard]] bool take(T& value) {
    if (bytes_.size() - at_ < sizeof(T)) return false;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return true;
  }
  [[nodiscard]] bool take(std::string& text, std::size_t length) {
    if (bytes_.size() - at_ < length) return false;
    text.clear();
    for (const std::uint8_t byte : bytes_.subspan(at_, length)) text.push_back(static_cast<char>(byte));
    at_ += length;
    return true;
  }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Bytes of one number; 0 for a type that the container does not know.
std::size_t type_bytes(std::uint8_t type) {
  constexpr std::array<std::size_t, 12> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};  // u8 i8 u16 .. i64, f16, f32, f64
  return type < sizes.size() ? sizes[type] : 0;
}

/// What one field says of itself, bounded; its bytes are not looked for yet.
struct Declared {
  Tensor tensor;
  std::uint64_t offset = 0, size = 0;
};

bool printable(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

Result<Declared> read_declaration(Cursor& cursor, std::size_t number, std::size_t file_size, const std::string& file) {
  Declared out;
  std::string where = "field " + std::to_string(number + 1);
  std::uint16_t length = 0, dimensions = 0;
  const auto cut = [&] { return fail(file, where, "the file ends inside its header", again); };
  if (!cursor.take(length)) return cut();
  if (length == 0 || length > max_name)
    return fail(file, where, "has a name of " + std::to_string(length) + " bytes", again);
  if (!cursor.take(out.tensor.name, length)) return cut();
  if (!printable(out.tensor.name)) return fail(file, where, "has no readable name", again);
  where = out.tensor.name;
  if (!cursor.take(dimensions) || !cursor.take(out.tensor.type) || !cursor.take(out.offset)) return cut();
  if (dimensions == 0 || dimensions > max_dimensions)
    return fail(file, where, "has " + std::to_string(dimensions) + " dimensions", again);
  out.size = type_bytes(out.tensor.type);
  if (out.size == 0) return fail(file, where, "has the unknown type " + std::to_string(out.tensor.type), again);
  out.tensor.count = 1;
  for (std::size_t k = 0; k < dimensions; ++k) {
    std::uint64_t extent = 0;
    if (!cursor.take(extent)) return cut();
    // Dividing, so that no product can run over.
    if (extent == 0 || extent > file_size / out.size)
      return fail(
          file, where,
          "declares " + std::to_string(extent) + " entries, and the file has " + std::to_string(file_size) + " bytes",
          again);
    out.size *= extent;
    out.tensor.count *= extent;
    out.tensor.shape.push_back(extent);
  }
  return out;
}

}  // namespace

std::vector<float> Tensor::floats() const {
  std::vector<float> out(count);
  std::memcpy(out.data(), bytes.data(), count * sizeof(float));
  return out;
}

Result<TensorFile> TensorFile::parse(std::span<const std::uint8_t> bytes, const std::string& file) {
  Cursor cursor(bytes);
  std::string head;
  std::uint8_t major = 0, minor = 0;
  std::uint32_t count = 0;
  if (bytes.empty()) return fail(file, "", "is empty", again);
  if (!cursor.take(head, std::min(magic.size(), bytes.size())) || head != magic)
    return fail(file, "header", "is no tensor file", "give a .bsdf file of the RGL material database");
  if (!cursor.take(major) || !cursor.take(minor) || !cursor.take(count))
    return fail(file, "header", "the file ends inside its header", again);
  if (major != 1 || minor != 0)
    return fail(file, "version", "is " + std::to_string(major) + "." + std::to_string(minor), "only 1.0 is known");
  if (count == 0 || count > max_fields)
    return fail(file, "header", "declares " + std::to_string(count) + " fields", again);
  std::vector<Declared> declared;
  for (std::size_t k = 0; k < count; ++k) {
    auto one = read_declaration(cursor, k, bytes.size(), file);
    if (!one) return tl::unexpected(one.error());
    for (const Declared& other : declared) {
      if (other.tensor.name == one->tensor.name) return fail(file, one->tensor.name, "is there twice", again);
    }
    declared.push_back(std::move(*one));
  }
  std::vector<const Declared*> order;
  for (Declared& one : declared) {
    if (one.offset < cursor.at() || one.offset > bytes.size() || one.size > bytes.size() - one.offset)
      return fail(file, one.tensor.name,
                  "lies at bytes " + std::to_string(one.offset) + " + " + std::to_string(one.size) + " of " +
                      std::to_string(bytes.size()),
                  again);
    one.tensor.bytes = bytes.subspan(one.offset, one.size);
    order.push_back(&one);
  }
  std::sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->offset < b->offset; });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (order[k - 1]->offset + order[k - 1]->size > order[k]->offset)
      return fail(file, order[k]->tensor.name, "overlaps with " + order[k - 1]->tensor.name, again);
  }
  TensorFile out;
  out.file_ = file;
  for (Declared& one : declared) out.tensors_.push_back(std::move(one.tensor));
  return out;
}

const Tensor* TensorFile::find(std::string_view name) const {
  const auto at = std::find_if(tensors_.begin(), tensors_.end(), [&](const Tensor& t) { return t.name == name; });
  return at == tensors_.end() ? nullptr : &*at;
}

Result<const Tensor*> TensorFile::need(std::string_view name, TensorType type, std::size_t dimensions) const {
  const std::string field(name);
  const Tensor* tensor = find(name);
  if (tensor == nullptr) return fail(file_, field, "is missing", "give a .bsdf file of the RGL material database");
  if (tensor->type != static_cast<std::uint8_t>(type))
    return fail(file_, field,
                "has type " + std::to_string(tensor->type) + ", not " +
                    (type == TensorType::f32 ? "10 (float32)" : "1 (uint8)"),
                again);
  if (tensor->shape.size() != dimensions)
    return fail(file_, field,
                "has " + std::to_string(tensor->shape.size()) + " dimensions, not " + std::to_string(dimensions),
                again);
  return tensor;
}

}  // namespace lackwerk::packs
