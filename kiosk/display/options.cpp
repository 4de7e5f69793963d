#include "kiosk/display/options.hpp"

#include <getopt.h>

#include <array>
#include <charconv>
#include <cstring>

#include "render_gles/accumulator.hpp"
#include "render_gles/governor.hpp"

namespace lackwerk::kiosk {
namespace {

tl::unexpected<Error> usage(std::string option, std::string what, std::string remedy) {
  return fail("", std::move(option), std::move(what), std::move(remedy), ErrorKind::usage);
}

Result<int> read_count(const char* option, const char* text, int least, int most) {
  int count = 0;
  const char* end = text + std::strlen(text);
  const auto [at, code] = std::from_chars(text, end, count);
  if (code == std::errc{} && at == end && count >= least && count <= most) return count;
  return usage(option, "'" + std::string(text) + "' is not a number it can take",
               "give " + std::to_string(least) + " to " + std::to_string(most));
}

constexpr int max_record_samples = 64;
constexpr int max_frame_ms = 1000;

std::string rung_names() {
  std::string names = "auto";
  for (const gles::Rung& rung : gles::quality_ladder()) names += std::string(", ") + std::string(rung.name);
  return names;
}

enum Option {
  pack = 1,
  scene,
  platform,
  core_es2,
  size,
  frames,
  input_script,
  screenshot,
  record,
  record_samples,
  quality,
  frame_ms,
  still_frames,
  help,
  version
};

}  // namespace

const char* help_text() {
  return "Usage: lackwerk-kiosk --pack PACK.lwp --scene SCENE.lws [options]\n"
         "Shows a pack's paints on a scene and morphs between them.\n\n"
         "  --pack PACK.lwp         paints to show (required)\n"
         "  --scene SCENE.lws       what to show them on (required)\n"
         "  --platform NAME         surfaceless (EGL, default) or osmesa (software); both draw without a display\n"
         "  --core-es2 NAME         draw as the weakest OpenGL ES 2.0 driver would: no extensions, the promised "
         "limits, and\n"
         "                          highp or only mediump floats in fragment shaders\n"
         "  --size WxH              picture size in pixels (default 1280x720)\n"
         "  --input-script FILE     play a tour (tests/tours/*.tour) instead of waiting for input\n"
         "  --frames N              run N frames on a virtual clock of 30 a second, then end;\n"
         "                          without it: real time, until the tour ends or SIGTERM\n"
         "  --record DIR            write every frame to DIR/000000.png and so on\n"
         "  --record-samples N      samples a pixel of recorded frames, 1 (default: as shown) to 64\n"
         "  --quality NAME          how moving pictures are drawn: auto (default; holds the frame time), or best, "
         "fine,\n"
         "                          good, plain, lean, soft, least\n"
         "  --frame-ms N            frame time that auto holds, 1 to 1000 ms (default 62)\n"
         "  --still-frames N        frames a picture that does not change is refined with, 0 (never) to 256 (default "
         "64)\n"
         "  --screenshot OUT.png    write the last picture in still quality\n"
         "  --help, --version\n\n"
         "Exit codes: 0 done, 1 the run failed, 2 usage.\n";
}

Result<Options> parse_options(int argc, char** argv) {
  static constexpr std::array<::option, 16> known{{{"pack", required_argument, nullptr, pack},
                                                   {"scene", required_argument, nullptr, scene},
                                                   {"platform", required_argument, nullptr, platform},
                                                   {"core-es2", required_argument, nullptr, core_es2},
                                                   {"size", required_argument, nullptr, size},
                                                   {"frames", required_argument, nullptr, frames},
                                                   {"input-script", required_argument, nullptr, input_script},
                                                   {"screenshot", required_argument, nullptr, screenshot},
                                                   {"record", required_argument, nullptr, record},
                                                   {"record-samples", required_argument, nullptr, record_samples},
                                                   {"quality", required_argument, nullptr, quality},
                                                   {"frame-ms", required_argument, nullptr, frame_ms},
                                                   {"still-frames", required_argument, nullptr, still_frames},
                                                   {"help", no_argument, nullptr, help},
                                                   {"version", no_argument, nullptr, version},
                                                   {nullptr, 0, nullptr, 0}}};
  Options options;
  optind = 0;  // glibc: start afresh, so that tests may parse more than once
  opterr = 0;
  for (int found; (found = getopt_long(argc, argv, "", known.data(), nullptr)) != -1;) {
    switch (found) {
      case pack:
        options.pack = optarg;
        break;
      case scene:
        options.scene = optarg;
        break;
      case platform:
        if (std::strcmp(optarg, "surfaceless") == 0)
          options.backend = gles::Backend::egl_surfaceless;
        else if (std::strcmp(optarg, "osmesa") == 0)
          options.backend = gles::Backend::osmesa;
        else
          return usage("--platform", "unknown platform '" + std::string(optarg) + "'", "use surfaceless or osmesa");
        break;
      case core_es2: {
        const auto parsed = gles::parse_core_es2(optarg);
        if (!parsed)
          return usage("--core-es2", "unknown precision '" + std::string(optarg) + "'", "use highp or mediump");
        options.core_es2 = *parsed;
        break;
      }
      case size: {
        auto parsed = parse_size(optarg);
        if (!parsed) return tl::unexpected(parsed.error());
        options.size = *parsed;
        break;
      }
      case frames: {
        auto count = read_count("--frames", optarg, 1, max_frames);
        if (!count) return tl::unexpected(count.error());
        options.frames = *count;
        break;
      }
      case input_script:
        options.input_script = optarg;
        break;
      case screenshot:
        options.screenshot = optarg;
        break;
      case record:
        options.record = optarg;
        break;
      case record_samples: {
        auto count = read_count("--record-samples", optarg, 1, max_record_samples);
        if (!count) return tl::unexpected(count.error());
        options.record_samples = *count;
        break;
      }
      case quality:
        options.quality = optarg;
        if (options.quality != "auto" && gles::find_rung(options.quality) == nullptr)
          return usage("--quality", "unknown quality '" + options.quality + "'", "use one of " + rung_names());
        break;
      case frame_ms: {
        auto count = read_count("--frame-ms", optarg, 1, max_frame_ms);
        if (!count) return tl::unexpected(count.error());
        options.frame_ms = *count;
        break;
      }
      case still_frames: {
        auto count = read_count("--still-frames", optarg, 0, gles::Accumulator::max_frames);
        if (!count) return tl::unexpected(count.error());
        options.still_frames = *count;
        break;
      }
      case help:
        options.help = true;
        return options;
      case version:
        options.version = true;
        return options;
      default:
        return usage(argv[optind - 1], "unknown option, or its value is missing", "see --help");
    }
  }
  if (optind < argc) return usage(argv[optind], "is not an option", "see --help");
  if (options.pack.empty()) return usage("--pack", "no paint pack given", "--pack PACK.lwp");
  if (options.scene.empty()) return usage("--scene", "no scene given", "--scene SCENE.lws");
  return options;
}

}  // namespace lackwerk::kiosk
