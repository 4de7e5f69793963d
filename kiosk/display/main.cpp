// lackwerk-kiosk: the program that runs in the showroom.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "kiosk/display/config_text.hpp"
#include "kiosk/display/import.hpp"
#include "kiosk/display/loop.hpp"
#include "kiosk/display/options.hpp"
#include "kiosk/display/pin.hpp"

namespace {

constexpr int exit_done = 0, exit_failed = 1, exit_usage = 2;

int report(const lackwerk::Error& error) {
  std::fprintf(stderr, "lackwerk-kiosk: %s\n", error.line().c_str());
  return error.kind == lackwerk::ErrorKind::usage ? exit_usage : exit_failed;
}

void on_signal(int /*number*/) { lackwerk::kiosk::request_stop(); }

/// A PIN from standard input, its line for kiosk.toml to standard output.
int hash_typed_pin() {
  std::string typed;
  std::getline(std::cin, typed);
  const auto line = lackwerk::kiosk::pin_line(typed);
  if (!line) return report(line.error());
  std::fputs(line->c_str(), stdout);
  return exit_done;
}

/// Packs of a stick into the store; what became of them for the kiosk that runs beside this.
int import_from(const lackwerk::kiosk::Options& options) {
  const char* run_time = std::getenv("RUNTIME_DIRECTORY");
  const auto& packs = options.config.packs;
  const auto good = lackwerk::kiosk::import_stick(
      {options.import, packs.store, packs.keyring, run_time != nullptr ? run_time : "/run/lackwerk"});
  if (!good) return report(good.error());
  return *good ? exit_done : exit_failed;
}

int run(int argc, char** argv) {
  const auto options = lackwerk::kiosk::parse_options(argc, argv);
  if (!options) return report(options.error());
  if (options->help || options->version) {
    std::fputs(options->help ? lackwerk::kiosk::help_text() : "lackwerk-kiosk " LACKWERK_VERSION "\n", stdout);
    return exit_done;
  }
  if (options->sample_config) {
    std::fputs(lackwerk::kiosk::config_text().c_str(), stdout);
    return exit_done;
  }
  if (options->hash_pin) return hash_typed_pin();
  if (!options->import.empty()) return import_from(*options);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const auto summary = lackwerk::kiosk::run(*options);
  if (!summary) return report(summary.error());
  std::printf(
      "%llu frames, %llu drawn, %llu refined; quality %s; median %.1f ms a drawn frame (realise and upload %.2f "
      "ms); %.2f MB uploaded\n",
      static_cast<unsigned long long>(summary->frames), static_cast<unsigned long long>(summary->drawn),
      static_cast<unsigned long long>(summary->refined), summary->quality.c_str(), summary->drawn_ms_median,
      summary->realise_ms_median, static_cast<double>(summary->uploaded_bytes) * 1e-6);
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    return report({"", "", error.what(), "please report this"});
  }
}
