#include "render_gles/image.hpp"

#include <png.h>

#include <memory>

#include "core/check.hpp"

namespace lackwerk::gles {
namespace {

// libpng's simplified interface reports errors by value; the full one would longjmp over destructors.
struct FreePng {
  void operator()(png_image* image) const { png_image_free(image); }
};

}  // namespace

Result<void> write_png(const Image& image, const std::string& path) {
  check_equal(image.rgb.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3,
              "bytes of an image");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, FreePng> owner(&png);
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&png, path.c_str(), 0, image.rgb.data(), 0, nullptr) == 0)
    return fail(path, "", std::string("cannot write the PNG: ") + png.message, "is the folder there and writable?");
  return {};
}

Result<Image> read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, FreePng> owner(&png);
  if (png_image_begin_read_from_file(&png, path.c_str()) == 0)
    return fail(path, "", std::string("cannot read the PNG: ") + png.message, "give a PNG file");
  if (png.width > max_image_edge || png.height > max_image_edge)
    return fail(path, "size", std::to_string(png.width) + "x" + std::to_string(png.height) + " is too large",
                "at most " + std::to_string(max_image_edge) + " pixels an edge");
  png.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&png, &black, image.rgb.data(), 0, nullptr) == 0)
    return fail(path, "", std::string("damaged PNG: ") + png.message, "make it again");
  return image;
}

}  // namespace lackwerk::gles
