#include "kiosk/display/interface.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "input/source.hpp"
#include "kiosk/display/calibration.hpp"
#include "kiosk/display/pack_facts.hpp"
#include "kiosk/display/targets.hpp"
#include "kiosk/display/test_pattern.hpp"

namespace lackwerk::kiosk {
namespace {

using input::Control;
using input::ControlKind;

/// Dealers see a device that was plugged in within this.
constexpr double facts_every_ms = 1000.0;
constexpr double usual_dpi = 96.0;
/// From one pack's picture to the next one's.
constexpr double fade_ms = 700.0;
/// Fingers of scripts do not meet those of devices.
constexpr int first_scripted_contact = 1'000'000;
/// Where the nearest paint is shown beside the mix, in parts of the picture's width: the layout's divider.
constexpr float middle = 0.5f;

bool is_touch(const Control& event) {
  return event.kind == ControlKind::touch_down || event.kind == ControlKind::touch_move ||
         event.kind == ControlKind::touch_up || event.kind == ControlKind::touch_cancel;
}

ui::Content content_of(const packs::ExhibitPack& pack, bool vouched) {
  ui::Content content = pack.scans() != nullptr ? ui::ui_content(*pack.scans()) : ui::ui_content(*pack.paints());
  content.is_vouched = vouched;
  return content;
}

ExperienceLinks links_of(const packs::ExhibitPack& pack, const InterfaceSettings& settings) {
  ExperienceLinks links = links_to(pack, settings.pin);
  links.wall_s = settings.wall_s ? settings.wall_s : wall_clock_s;
  return links;
}

/// The room that the eye keeps within. Scans stand in none: how far the eye may go says the camera rig.
Room room_on(const Stage& stage) { return stage.shows_scans() ? Room{} : room_of(stage.scene()); }

gles::OverlaySprite overlay_sprite(const ui::Sprite& from) {
  return {from.tile, from.x_px, from.y_px, from.width_px, from.height_px, from.opacity};
}

}  // namespace

double wall_clock_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

Interface::Interface(Stage& stage, const InterfaceSettings& settings, Log& log)
    : stage_(stage),
      settings_(settings),
      log_(log),
      experience_(content_of(stage.pack(), settings.vouched), stage.cameras(), settings.experience,
                  links_of(stage.pack(), settings), room_on(stage)),
      drift_(settings.drift_px) {}

Result<std::unique_ptr<Interface>> Interface::create(Stage& stage, const InterfaceSettings& settings, Log& log) {
  InterfaceSettings known = settings;
  known.experience.has_pin = !settings.pin.empty();
  // The constructor is private, so make_unique cannot be used.
  std::unique_ptr<Interface> made(new Interface(stage, known, log));
  if (settings.shown)
    if (auto ready = made->set_up(); !ready) return tl::unexpected(ready.error());
  made->set_surface(Rotation::none, {stage.framebuffer().width(), stage.framebuffer().height()});
  return made;
}

Result<void> Interface::set_up() {
  auto painter = ui::Painter::create();
  if (!painter) return tl::unexpected(painter.error());
  auto overlay = gles::Overlay::create(stage_.context());
  if (!overlay) return tl::unexpected(overlay.error());
  painter_ = std::move(*painter);
  overlay_ = std::move(*overlay);
  make_swatches();
  return {};
}

void Interface::set_surface(Rotation rotation, std::array<int, 2> panel_px, double panel_dpi) {
  rotation_ = rotation;
  const double known_dpi = settings_.dpi > 0.0 ? settings_.dpi : panel_dpi;
  experience_.set_surface(rotation, panel_px, known_dpi > 0.0 ? known_dpi : usual_dpi);
  script_fingers_.clear();
  painted_ = false;
  size_swatches();
}

void Interface::make_swatches() {
  const packs::PaintPack* paints = stage_.pack().paints();
  swatches_ = paints == nullptr
                  ? nullptr
                  : std::make_unique<Swatches>(stage_.context(), paints->paint(), stage_.scene().environment);
}

void Interface::size_swatches() {
  if (!painter_ || !swatches_) return;
  constexpr int least_px = 16, most_px = 1024;
  swatches_->wants(
      std::clamp(painter_->swatch_edge_px(experience_.surface(), experience_.content()), least_px, most_px));
}

void Interface::content_changed(double now_ms, bool vouched) {
  compared_.reset();
  if (overlay_) {
    // What is on the framebuffer is still the old paint: nothing of the new one has been drawn.
    if (auto held = overlay_->hold(stage_.framebuffer()); held)
      fading_since_ms_ = now_ms;
    else
      log_.error(held.error());
  }
  experience_.set_links(links_of(stage_.pack(), settings_));
  experience_.set_content(content_of(stage_.pack(), vouched), stage_.cameras(), room_on(stage_));
  painted_ = false;
  if (!painter_) return;
  make_swatches();
  for (std::size_t k = 0; k < core::max_paints; ++k) painter_->set_swatch(k, 0, {});
  size_swatches();
}

void Interface::note(const Changes& changes) {
  if (changes.interface) painted_ = false;
}

Control Interface::calibrated_and_moved(Control event) const {
  if (!is_touch(event) || event.values.size() != 2) return event;
  Point at{event.values[0], event.values[1]};
  if (settings_.experience.calibration) at = calibrated(*settings_.experience.calibration, at);
  // Who touches what has drifted means what it is.
  const auto drift = drift_.at();
  const auto& size = experience_.surface().size_px;
  Point seen = picture_point(rotation_, at);
  for (std::size_t k = 0; k < 2; ++k) seen[k] -= static_cast<double>(drift[k]) / size[k];
  at = panel_point(rotation_, seen);
  event.values = {at[0], at[1]};
  return event;
}

std::optional<Control> Interface::placed(const Control& event) {
  Control out = event;
  out.contact = first_scripted_contact + event.contact;
  out.name.clear();
  if (event.kind == ControlKind::touch_up || event.kind == ControlKind::touch_cancel) {
    const bool was_down = script_fingers_.erase(out.contact) > 0;
    return was_down ? std::optional(out) : std::nullopt;
  }
  const auto target = input::parse_target(event.name);
  if (!target || event.values.size() != 1) return std::nullopt;
  const ui::Surface& surface = experience_.surface();
  const auto to = target_place(*target, surface, experience_.content(), experience_.model());
  if (!to) {
    complaint_ = to.error();
    return std::nullopt;
  }
  ui::Place at = *to;
  if (event.kind == ControlKind::touch_move) {
    const auto finger = script_fingers_.find(out.contact);
    if (finger == script_fingers_.end()) return std::nullopt;  // its touch has found nothing, and said so
    const double way = event.values[0];
    for (std::size_t k = 0; k < 2; ++k) at[k] = finger->second[k] + way * (at[k] - finger->second[k]);
    if (way >= 1.0) finger->second = at;
  } else {
    script_fingers_[out.contact] = at;
  }
  const Point panel = panel_point(rotation_, {at[0] / surface.size_px[0], at[1] / surface.size_px[1]});
  out.values = {panel[0], panel[1]};
  return out;
}

Interface::Changes Interface::take(const Control& event, double now_ms) {
  input_ms_ = now_ms;
  std::optional<Control> meant;
  if (is_touch(event) && !event.name.empty())
    meant = placed(event);
  else
    meant = calibrated_and_moved(event);
  if (!meant) return {};
  const Changes changes = experience_.take(*meant, now_ms);
  note(changes);
  return changes;
}

Interface::Changes Interface::begin_visit(double now_ms) {
  return take({ControlKind::orbit, {0.0, 0.0}, {}, 0, 0}, now_ms);
}

Interface::Changes Interface::tell(ui::Toast toast, double now_ms) {
  const Changes changes = experience_.tell(std::move(toast), now_ms);
  note(changes);
  // The dealer's page has news too.
  facts_ms_ = -1e300;
  return changes;
}

Interface::Changes Interface::advance(double now_ms, int minute_of_day) {
  const Changes changes = experience_.advance(now_ms, minute_of_day);
  note(changes);
  drift_.advance(now_ms, input_ms_);
  now_ms_ = now_ms;
  if (fading_since_ms_ && now_ms >= *fading_since_ms_ + fade_ms) {
    fading_since_ms_.reset();
    if (!compared_) overlay_->let_go();
  }
  return changes;
}

double Interface::wake_at_ms(double now_ms) const {
  if (fading_since_ms_) return now_ms;
  double wake = experience_.wake_at_ms(now_ms);
  if (painter_ && !model().asleep) wake = std::min(wake, drift_.wake_at_ms(input_ms_));
  if (painter_ && model().screen == ui::Screen::dealer) wake = std::min(wake, facts_ms_ + facts_every_ms);
  return wake;
}

bool Interface::compare(bool current) {
  if (!overlay_) return false;
  const auto& nearest = model().nearest;
  if (!nearest) {
    if (!compared_) return false;
    compared_.reset();
    overlay_->let_go();
    return true;
  }
  if (compared_ && compared_paint_ == nearest->paint) return false;
  if (!compared_) {
    if (!current) return false;  // the mix comes first
    if (auto held = overlay_->hold(stage_.framebuffer()); !held) {
      log_.error(held.error());
      return false;
    }
    // The view stays as it is held, or the halves would not meet.
    compared_ = experience_.state();
  }
  compared_paint_ = nearest->paint;
  core::Weights alone = core::Weights::uniform(std::vector<double>(experience_.content().paints.size(), 0.0));
  for (auto* group : {&alone.base, &alone.flake_lightness, &alone.flake_colour})
    (*group)[static_cast<std::size_t>(nearest->paint)] = 1.0;
  compared_->set_weights(alone);
  return true;
}

float Interface::brightness() const {
  if (!painter_ || model().dealer.test_pattern) return 1.0f;
  return static_cast<float>(model().dealer.brightness *
                            (model().screen == ui::Screen::attract ? settings_.attract_brightness : 1.0));
}

gles::OverlayLook Interface::look() const {
  gles::OverlayLook look;
  const auto drift = drift_.at();
  look.drift_x_px = drift[0];
  look.drift_y_px = drift[1];
  look.brightness = brightness();
  if (compared_) look.split = middle;
  if (fading_since_ms_ && !compared_) {
    // Eased at both ends: smoothstep.
    const double t = std::clamp((now_ms_ - *fading_since_ms_) / fade_ms, 0.0, 1.0);
    look.held = static_cast<float>(1.0 - t * t * (3.0 - 2.0 * t));
  }
  return look;
}

bool Interface::stale() const {
  if (!painter_) return false;
  return dirty_ || !painted_ || look() != composed_ || pattern_shown_ != model().dealer.test_pattern;
}

bool Interface::wants_facts(double now_ms) const {
  return painter_ && model().screen == ui::Screen::dealer && now_ms >= facts_ms_ + facts_every_ms;
}

void Interface::show_facts(ui::DealerFacts facts, double now_ms) {
  facts_ = std::move(facts);
  facts_ms_ = now_ms;
  painted_ = false;
}

void Interface::paint() {
  if (painted_) return;
  painted_ = true;
  const bool dealer = model().screen == ui::Screen::dealer;
  if (!dealer) facts_.reset();
  if (dealer && !facts_) facts_.emplace();  // until there are some
  const ui::Painted& painted =
      painter_->paint(experience_.surface(), experience_.content(), model(), facts_ ? &*facts_ : nullptr);
  for (const std::uint32_t tile : painted.gone) overlay_->drop_tile(tile);
  for (const ui::TileUpdate& tile : painted.updates)
    overlay_->set_tile(tile.tile, tile.width, tile.height, tile.stride_bytes, tile.bgra);
  std::vector<gles::OverlaySprite> sprites;
  sprites.reserve(painted.sprites.size());
  for (const ui::Sprite& sprite : painted.sprites) sprites.push_back(overlay_sprite(sprite));
  dirty_ |= sprites != sprites_ || !painted.updates.empty();
  sprites_ = std::move(sprites);
}

Result<const gles::Framebuffer*> Interface::pattern(const gles::Framebuffer& picture) {
  const int width = picture.width(), height = picture.height();
  if (!pattern_ || pattern_->width() != width || pattern_->height() != height) {
    auto made = gles::Framebuffer::create(stage_.context(), width, height, gles::PixelFormat::rgba8, false);
    if (!made) return tl::unexpected(made.error());
    const gles::Image image = test_pattern(width, height);
    std::vector<std::uint8_t> rgba(image.rgb.size() / 3 * 4, 255);
    std::uint8_t* out = rgba.data();
    for (int y = height - 1; y >= 0; --y)
      for (int x = 0; x < width; ++x, out += 4) std::copy_n(image.pixel(x, y), 3, out);
    const gles::GlApi& gl = stage_.context().gl();
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D, made->texture());
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    pattern_ = std::move(*made);
  }
  return &*pattern_;
}

Result<const gles::Framebuffer*> Interface::compose(const gles::Framebuffer& picture, Dimming dimming) {
  if (!painter_) return &picture;
  pattern_shown_ = model().dealer.test_pattern;
  if (!pattern_shown_) pattern_.reset();
  paint();
  dirty_ = false;
  composed_ = look();
  if (pattern_shown_) return pattern(picture);
  gles::OverlayLook drawn = composed_;
  if (dimming == Dimming::later) drawn.brightness = 1.0f;
  return overlay_->compose(picture, sprites_, drawn);
}

void Interface::make_swatch() {
  if (!swatches_) return;
  auto made = swatches_->next();
  if (!made) {
    log_.error(made.error());
    return;
  }
  if (!*made) return;
  painter_->set_swatch((*made)->paint, (*made)->edge_px, std::move((*made)->rgb));
  painted_ = false;
}

std::vector<ControlStatus> Interface::controls() const {
  std::vector<ControlStatus> out;
  if (!painter_) return out;
  const ui::Surface& surface = experience_.surface();
  const auto drift = drift_.at();
  const auto add = [&](const char* name, int index, ui::Place px) {
    const Point panel =
        panel_point(rotation_, {(px[0] + drift[0]) / surface.size_px[0], (px[1] + drift[1]) / surface.size_px[1]});
    out.push_back({name, index, panel[0], panel[1]});
  };
  for (const ui::Item& item : ui::layout(surface, experience_.content(), model())) {
    add(widget_name(item.widget), item.index, item.rect.centre());
    if (item.widget != ui::Widget::pad) continue;
    const ui::Rect field = ui::pad_field(surface, item.rect);
    add("puck", 0, {field.x + model().puck[0] * field.width, field.y + model().puck[1] * field.height});
  }
  return out;
}

std::optional<Error> Interface::take_complaint() {
  std::optional<Error> out;
  std::swap(out, complaint_);
  return out;
}

std::optional<DealerChoices> Interface::take_choices() {
  auto choices = experience_.take_choices();
  if (choices) settings_.experience.calibration = choices->calibration;
  return choices;
}

}  // namespace lackwerk::kiosk
