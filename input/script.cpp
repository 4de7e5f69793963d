#include "input/script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace lackwerk::input {
namespace {

std::vector<std::string> split_words(const std::string& line) {
  std::istringstream in(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::optional<double> number(const std::string& word) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<ControlKind> kind_of(const std::string& word) {
  if (word == "weights") return ControlKind::weights;
  if (word == "base") return ControlKind::base;
  if (word == "lightness") return ControlKind::flake_lightness;
  if (word == "colour") return ControlKind::flake_colour;
  if (word == "camera") return ControlKind::camera;
  if (word == "orbit") return ControlKind::orbit;
  if (word == "zoom") return ControlKind::zoom;
  return std::nullopt;
}

bool is_weights(ControlKind kind) {
  return kind == ControlKind::weights || kind == ControlKind::base || kind == ControlKind::flake_lightness ||
         kind == ControlKind::flake_colour;
}

/// What is wrong with a step's values, or nothing.
const char* complaint(const ScriptStep& step) {
  const auto& values = step.control.values;
  switch (step.control.kind) {
    case ControlKind::camera:
      return step.control.name.empty() ? "camera needs a name" : nullptr;
    case ControlKind::orbit:
      return values.size() != 2 ? "orbit needs azimuth and elevation in degrees" : nullptr;
    case ControlKind::zoom:
      return values.size() != 1 || values[0] <= 0.0 ? "zoom needs one factor above 0" : nullptr;
    default:
      return values.empty() || values.size() > 16 ? "weights need one number per paint" : nullptr;
  }
}

Result<ScriptStep> parse_step(const std::vector<std::string>& words, const std::string& file,
                              const std::string& field) {
  const auto at = number(words[0]);
  if (!at || *at < 0.0 || *at > max_script_ms)
    return fail(file, field, "'" + words[0] + "' is not a time in milliseconds", "begin the line with a time from 0");
  const auto kind = words.size() > 1 ? kind_of(words[1]) : std::nullopt;
  if (!kind)
    return fail(file, field, "unknown command '" + (words.size() > 1 ? words[1] : "") + "'",
                "use weights, base, lightness, colour, camera, orbit or zoom");
  ScriptStep step{*at, 0.0, {*kind, {}, {}}};
  for (std::size_t k = 2; k < words.size(); ++k) {
    if (words[k] == "over" && k + 2 == words.size()) {
      const auto over = number(words[k + 1]);
      if (!over || *over < 0.0 || *over > max_script_ms)
        return fail(file, field, "'" + words[k + 1] + "' is not a duration", "write 'over MILLISECONDS'");
      step.over_ms = *over;
      break;
    }
    if (*kind == ControlKind::camera && step.control.name.empty()) {
      step.control.name = words[k];
      continue;
    }
    const auto value = number(words[k]);
    if (!value) return fail(file, field, "'" + words[k] + "' is not a number");
    step.control.values.push_back(*value);
  }
  if (const char* wrong = complaint(step)) return fail(file, field, wrong);
  return step;
}

/// Smooth start and end, so that a morph neither jerks nor stops dead.
double ease(double t) { return t * t * (3.0 - 2.0 * t); }

}  // namespace

Result<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file) {
  std::vector<ScriptStep> steps;
  std::istringstream in{std::string(text)};
  int line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    const auto words = split_words(line);
    if (words.empty()) continue;
    const std::string field = "line " + std::to_string(line_number);
    auto step = parse_step(words, file, field);
    if (!step) return tl::unexpected(step.error());
    if (!steps.empty() && step->at_ms < steps.back().at_ms)
      return fail(file, field, "goes back in time", "sort the lines by time");
    steps.push_back(std::move(*step));
  }
  return steps;
}

Result<std::vector<ScriptStep>> read_script(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(path.string(), "", "cannot be read", "check the path");
  std::string text(max_script_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (in.fail() && !in.eof())) return fail(path.string(), "", "cannot be read", "is it a folder?");
  if (text.size() > max_script_bytes) return fail(path.string(), "", "is larger than 1 MiB", "split the tour");
  return parse_script(text, path.string());
}

ScriptPlayer::ScriptPlayer(std::vector<ScriptStep> steps, std::vector<double> start)
    : steps_(std::move(steps)), base_(start), lightness_(start), colour_(std::move(start)) {}

std::vector<double>& ScriptPlayer::last_of(ControlKind kind) {
  if (kind == ControlKind::flake_lightness) return lightness_;
  if (kind == ControlKind::flake_colour) return colour_;
  return base_;
}

std::vector<Control> ScriptPlayer::advance(double now_ms) {
  while (next_ < steps_.size() && steps_[next_].at_ms <= now_ms) {
    const ScriptStep& step = steps_[next_++];
    running_.push_back({step, is_weights(step.control.kind) ? last_of(step.control.kind) : std::vector<double>{}, 0.0});
  }
  std::vector<Control> events;
  for (Running& run : running_) {
    const double linear =
        run.step.over_ms > 0.0 ? std::clamp((now_ms - run.step.at_ms) / run.step.over_ms, 0.0, 1.0) : 1.0;
    const double progress = ease(linear);
    Control event = run.step.control;
    if (is_weights(event.kind)) {
      if (progress < 1.0 && run.from.size() == event.values.size())
        for (std::size_t k = 0; k < event.values.size(); ++k)
          event.values[k] = run.from[k] + (event.values[k] - run.from[k]) * progress;
      if (event.kind == ControlKind::weights) base_ = lightness_ = colour_ = event.values;
      last_of(event.kind) = event.values;
    } else if (event.kind == ControlKind::orbit) {
      for (double& value : event.values) value *= progress - run.done;
    } else if (event.kind == ControlKind::zoom) {
      event.values[0] = std::pow(event.values[0], progress - run.done);
    }
    run.done = progress;
    events.push_back(std::move(event));
  }
  std::erase_if(running_, [](const Running& run) { return run.done >= 1.0; });
  return events;
}

}  // namespace lackwerk::input
