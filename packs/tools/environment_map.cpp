#include "packs/tools/environment_map.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>

#include "packs/tools/picture_file.hpp"

namespace lackwerk::packs {
namespace {

constexpr int max_width = 16384, max_height = max_width / 2 + 1;
constexpr PictureLimits map_limits{max_width,
                                   max_height,
                                   std::size_t{max_width} * max_height,
                                   4,
                                   "use a lat-long map of at most 16384x8192 pixels",
                                   "the file is damaged: fetch it again"};

std::string extension_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::vector<std::string> describe(const core::MapRepairs& repairs) {
  std::vector<std::string> out;
  if (repairs.negative > 0) out.push_back(std::to_string(repairs.negative) + " negative pixels were set to 0");
  if (repairs.not_finite > 0)
    out.push_back(std::to_string(repairs.not_finite) +
                  " infinite or undefined pixels were filled from their neighbours");
  return out;
}

}  // namespace

Result<EnvironmentMap> read_environment_map(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string ending = extension_of(path);
  if (ending != ".hdr" && ending != ".exr")
    return fail(file, "format", "is no HDR map", "use a lat-long map in .hdr or .exr", ErrorKind::usage);
  const auto picture = read_picture(path, map_limits);
  if (!picture) return tl::unexpected(picture.error());
  const auto channels = static_cast<std::size_t>(picture->channels);
  const std::size_t count = picture->values.size() / channels;
  EnvironmentMap out{{file, picture->width, picture->height, {}}, {}};
  out.map.pixels.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const float* v = &picture->values[k * channels];
    out.map.pixels.push_back(channels < 3 ? glm::vec3(v[0]) : glm::vec3(v[0], v[1], v[2]));
  }
  const auto repairs = core::repair(out.map);  // its messages name the file
  if (!repairs) return tl::unexpected(repairs.error());
  out.repairs = describe(*repairs);
  out.map.name = path.stem().string();
  return out;
}

Result<LoadedEnvironment> load_environment(const std::filesystem::path& path, const core::EnvironmentRoom& room) {
  auto read = read_environment_map(path);
  if (!read) return tl::unexpected(read.error());
  return LoadedEnvironment{core::build_environment(read->map, room), std::move(read->repairs)};
}

}  // namespace lackwerk::packs
