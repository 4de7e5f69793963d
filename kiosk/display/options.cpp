#include "kiosk/display/options.hpp"

#include <getopt.h>

#include <array>
#include <charconv>
#include <cstring>
#include <string_view>
#include <vector>

#include "kiosk/display/interface_words.hpp"
#include "kiosk/display/quality_table.hpp"
#include "kiosk/display/stage.hpp"
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
  config_file = 1,
  pack,
  scene,
  platform,
  connector,
  rotation,
  test_pattern,
  sample_config,
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
  no_interface,
  language,
  hash_pin,
  import_from,
  store,
  keyring,
  help,
  version
};

/// The value of --config, wherever it stands; null if it is not given.
const char* config_named(int argc, char** argv) {
  const char* named = nullptr;
  constexpr std::string_view word = "--config";
  for (int k = 1; k < argc; ++k) {
    const std::string_view given = argv[k];
    if (given == word && k + 1 < argc) named = argv[k + 1];
    if (given.starts_with("--config=")) named = argv[k] + word.size() + 1;
  }
  return named;
}

}  // namespace

const char* help_text() {
  return "Usage: lackwerk-kiosk [--config kiosk.toml] [--pack PACK.lwp]... [--scene SCENE.lws] [options]\n"
         "Shows a pack's paints on a scene and morphs between them. Options stand over the configuration file.\n\n"
         "  --config FILE           configuration (kiosk.toml); --sample-config prints one with every key and default\n"
         "  --pack PACK.lwp         paints to show, signed or not; without it what the file says, or the store holds\n"
         "  --scene SCENE.lws       what to show them on (needed here or in the file)\n"
         "  --platform NAME         auto (default: the first of kms, dumb, fbdev that can be had; with --frames:\n"
         "                          surfaceless), kms, dumb, fbdev;\n"
         "                          surfaceless (EGL) and osmesa (software) draw without a display\n"
         "  --connector NAME        show on this connector (HDMI-A-1) instead of the first connected one\n"
         "  --rotation DEGREES      turn the picture clockwise by 0, 90, 180 or 270\n"
         "  --test-pattern          show the panel's test pattern instead of the picture\n"
         "  --core-es2 NAME         draw as the weakest OpenGL ES 2.0 driver would: no extensions, the promised "
         "limits, and\n"
         "                          highp or only mediump floats in fragment shaders\n"
         "  --size WxH              picture size in pixels without a display (default 1280x720)\n"
         "  --input-script FILE     play a tour (tests/tours/*.tour), then end\n"
         "  --frames N              without a display: run N frames on a virtual clock of 30 a second, then end;\n"
         "                          with one: end after N pictures. Without it: until SIGTERM\n"
         "  --record DIR            write every frame to DIR/000000.png and so on (needs --frames)\n"
         "  --record-samples N      samples a pixel of recorded frames, 1 (default: as shown) to 64\n"
         "  --quality NAME          how moving pictures are drawn: auto (default; holds the frame time), or best, "
         "fine,\n"
         "                          good, plain, lean, soft, least\n"
         "  --frame-ms N            frame time that auto holds, 1 to 1000 ms (default 62)\n"
         "  --still-frames N        frames a picture that does not change is refined with, 0 (never) to 256 (default "
         "128)\n"
         "  --no-interface          the picture alone\n"
         "  --language WORD         of the texts: en, de or ar\n"
         "  --hash-pin              read a PIN of 4 to 12 digits from standard input, print the line for kiosk.toml\n"
         "  --import DIR            take the packs of the stick that is mounted there into the store, then end\n"
         "  --store DIR             the dealer's store of packs (default /var/lib/lackwerk/store)\n"
         "  --keyring DIR           keys whose packs are shown and imported (default /etc/lackwerk/keys)\n"
         "  --screenshot OUT.png    write the last picture in still quality\n"
         "  --help, --version\n\n"
         "With RUNTIME_DIRECTORY set (as systemd does), status.json is kept there: see docs/kiosk.md.\n"
         "Exit codes: 0 done, 1 the run failed, 2 usage.\n";
}

Result<Options> parse_options(int argc, char** argv) {
  static constexpr std::array<::option, 27> known{{{"config", required_argument, nullptr, config_file},
                                                   {"pack", required_argument, nullptr, pack},
                                                   {"scene", required_argument, nullptr, scene},
                                                   {"platform", required_argument, nullptr, platform},
                                                   {"connector", required_argument, nullptr, connector},
                                                   {"rotation", required_argument, nullptr, rotation},
                                                   {"test-pattern", no_argument, nullptr, test_pattern},
                                                   {"sample-config", no_argument, nullptr, sample_config},
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
                                                   {"no-interface", no_argument, nullptr, no_interface},
                                                   {"language", required_argument, nullptr, language},
                                                   {"hash-pin", no_argument, nullptr, hash_pin},
                                                   {"import", required_argument, nullptr, import_from},
                                                   {"store", required_argument, nullptr, store},
                                                   {"keyring", required_argument, nullptr, keyring},
                                                   {"help", no_argument, nullptr, help},
                                                   {"version", no_argument, nullptr, version},
                                                   {nullptr, 0, nullptr, 0}}};
  Options options;
  std::vector<std::string> named_packs;
  bool store_named = false;
  if (const char* file = config_named(argc, argv)) {
    auto config = read_config(file);
    if (!config) return tl::unexpected(config.error());
    options.config = std::move(*config);
  }
  optind = 0;  // glibc: start afresh, so that tests may parse more than once
  opterr = 0;
  for (int found; (found = getopt_long(argc, argv, "", known.data(), nullptr)) != -1;) {
    switch (found) {
      case config_file:
        break;  // read before the others, so that they stand over it
      case import_from:
        options.import = optarg;
        break;
      case store:
        options.config.packs.store = optarg;
        store_named = true;
        break;
      case keyring:
        options.config.packs.keyring = optarg;
        break;
      case pack:
        named_packs.emplace_back(optarg);
        break;
      case scene:
        options.config.scene = optarg;
        break;
      case connector:
        options.config.output.connector = optarg;
        break;
      case rotation: {
        const auto degrees = read_count("--rotation", optarg, 0, 270);
        const auto turned = degrees ? rotation_of(*degrees) : std::nullopt;
        if (!turned) return usage("--rotation", "'" + std::string(optarg) + "' is no rotation", "0, 90, 180 or 270");
        options.config.output.rotation = *turned;
        break;
      }
      case test_pattern:
        options.config.output.test_pattern = true;
        break;
      case sample_config:
        options.sample_config = true;
        return options;
      case platform:
        if (const auto named = platform_of(optarg))
          options.config.output.platform = *named;
        else
          return usage("--platform", "unknown platform '" + std::string(optarg) + "'",
                       "use auto, kms, dumb, fbdev, surfaceless or osmesa");
        break;
      case core_es2: {
        const auto parsed = gles::parse_core_es2(optarg);
        if (!parsed)
          return usage("--core-es2", "unknown precision '" + std::string(optarg) + "'", "use highp or mediump");
        options.config.output.context.core_es2 = *parsed;
        break;
      }
      case size: {
        auto parsed = parse_size(optarg);
        if (!parsed) return tl::unexpected(parsed.error());
        options.config.output.size_px = {parsed->width, parsed->height};
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
        options.config.picture.quality = optarg;
        if (options.config.picture.quality != "auto" && gles::find_rung(options.config.picture.quality) == nullptr)
          return usage("--quality", "unknown quality '" + options.config.picture.quality + "'",
                       "use one of " + rung_names());
        break;
      case frame_ms: {
        auto count = read_count("--frame-ms", optarg, 1, max_frame_ms);
        if (!count) return tl::unexpected(count.error());
        options.config.picture.frame_ms = *count;
        break;
      }
      case still_frames: {
        auto count = read_count("--still-frames", optarg, 0, gles::Accumulator::max_frames);
        if (!count) return tl::unexpected(count.error());
        options.config.picture.still_frames = *count;
        break;
      }
      case no_interface:
        options.config.interface.shown = false;
        break;
      case language: {
        const auto named = language_of(optarg);
        if (!named) return usage("--language", "unknown language '" + std::string(optarg) + "'", "use en, de or ar");
        options.config.interface.experience.language = *named;
        break;
      }
      case hash_pin:
        options.hash_pin = true;
        return options;
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
  if (!named_packs.empty()) {
    options.config.packs.files = std::move(named_packs);
    // Whoever types a pack's name answers for it.
    options.config.packs.allow_unsigned = true;
    options.config.packs.mark_unsigned = false;
  }
  if (!options.import.empty()) return options;
  if (options.config.packs.files.empty() && config_named(argc, argv) == nullptr && !store_named)
    return usage("--pack", "no paint pack given", "--pack PACK.lwp, or --store DIR, or --config FILE");
  if (options.config.scene.empty())
    return usage("--scene", "no scene given", "--scene SCENE.lws, or scene in --config");
  // Counted frames are for tests and recordings: they need no panel unless one is named.
  if (options.frames && options.config.output.platform == Platform::automatic)
    options.config.output.platform = Platform::surfaceless;
  if (!options.record.empty() && !options.frames)
    return usage("--record", "records frames of a virtual clock", "give --frames N too");
  options.config.picture.keep_free = options.config.interface.shown ? KeepFree::interface : KeepFree::nothing;
  if (!options.config.icc.empty()) {
    auto profile = read_icc(options.config.icc);
    if (!profile) return tl::unexpected(profile.error());
    options.config.output.profile = std::move(*profile);
  }
  if (!options.config.picture.quality_table.empty()) {
    const auto table = read_quality_table(options.config.picture.quality_table);
    if (!table) return tl::unexpected(table.error());
    options.config.picture.costs = table->costs();
  }
  return options;
}

}  // namespace lackwerk::kiosk
