// Plays what script.cpp has read.
#include <algorithm>
#include <cmath>

#include "input/script.hpp"

namespace lackwerk::input {
namespace {

/// Smooth start and end, so that a morph neither jerks nor stops dead.
double ease(double t) { return t * t * (3.0 - 2.0 * t); }

}  // namespace

ScriptPlayer::ScriptPlayer(std::vector<ScriptStep> steps, std::vector<double> start)
    : steps_(std::move(steps)), base_(start), lightness_(start), colour_(std::move(start)) {}

std::vector<double>* ScriptPlayer::last_of(ControlKind kind) {
  switch (kind) {
    case ControlKind::weights:
    case ControlKind::base:
      return &base_;
    case ControlKind::flake_lightness:
      return &lightness_;
    case ControlKind::flake_colour:
      return &colour_;
    case ControlKind::flake_white:
      return &white_;
    case ControlKind::dimmer:
      return &dimmer_;
    case ControlKind::time:
      return &time_;
    default:
      return nullptr;
  }
}

std::vector<Control> ScriptPlayer::advance(double now_ms) {
  while (next_ < steps_.size() && steps_[next_].at_ms <= now_ms) {
    const ScriptStep& step = steps_[next_++];
    const std::vector<double>* last = last_of(step.control.kind);
    running_.push_back({step, last != nullptr ? *last : std::vector<double>{}, 0.0});
  }
  std::vector<Control> events;
  for (Running& run : running_) {
    const double over_ms = run.step.over_ms;
    const double linear = over_ms > 0.0 ? std::clamp((now_ms - run.step.at_ms) / over_ms, 0.0, 1.0) : 1.0;
    const double progress = ease(linear);
    Control event = run.step.control;
    event.time_us = static_cast<std::uint64_t>(std::min(now_ms, run.step.at_ms + over_ms) * 1e3);
    if (std::vector<double>* last = last_of(event.kind)) {
      if (progress < 1.0 && run.from.size() == event.values.size())
        for (std::size_t k = 0; k < event.values.size(); ++k)
          event.values[k] = run.from[k] + (event.values[k] - run.from[k]) * progress;
      if (event.kind == ControlKind::weights) base_ = lightness_ = colour_ = event.values;
      *last = event.values;
    } else if (event.kind == ControlKind::orbit || event.kind == ControlKind::turn) {
      for (double& value : event.values) value *= progress - run.done;
    } else if (event.kind == ControlKind::zoom) {
      event.values[0] = std::pow(event.values[0], progress - run.done);
    } else if (event.kind == ControlKind::touch_move) {
      event.values[0] = progress;
    }
    run.done = progress;
    events.push_back(std::move(event));
  }
  std::erase_if(running_, [](const Running& run) { return run.done >= 1.0; });
  return events;
}

}  // namespace lackwerk::input
