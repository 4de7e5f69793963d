#include "kiosk/display/choices.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "input/touch.hpp"
#include "kiosk/display/interface_words.hpp"
#include "kiosk/display/pin_pad.hpp"

namespace lackwerk::kiosk {
namespace {

using Json = nlohmann::ordered_json;

constexpr double least_brightness = 0.2, most_brightness = 1.0;
constexpr const char* language_key = "language";
constexpr const char* beyond_key = "beyond";
constexpr const char* motion_key = "reduced_motion";
constexpr const char* brightness_key = "brightness";
constexpr const char* calibration_key = "calibration";
constexpr const char* pin_wrong_key = "pin_wrong";
constexpr const char* pin_lock_key = "pin_lock_s";
constexpr const char* pin_until_key = "pin_locked_until_s";
/// Seconds since 1970 that a clock may say: until the year 9999.
constexpr double most_wall_s = 253'402'300'799.0;

/// Reads one key after the other and keeps the first that is wrong.
class Reader {
 public:
  explicit Reader(const Json& from) : from_(from) {}

  void take(const char* key, ui::Language& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    const auto named = value->is_string() ? language_of(value->get_ref<const std::string&>()) : std::nullopt;
    named ? void(to = *named) : refuse(key);
  }
  void take(const char* key, bool& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    value->is_boolean() ? void(to = value->get<bool>()) : refuse(key);
  }
  void take(const char* key, double& to, double least, double most) {
    const Json* value = find(key);
    if (value == nullptr) return;
    const double number = value->is_number() ? value->get<double>() : least - 1.0;
    number >= least&& number <= most ? void(to = number) : refuse(key);
  }
  void take(const char* key, int& to, int least, int most) {
    double number = to;
    take(key, number, least, most);
    to = static_cast<int>(number);
  }
  void take(const char* key, std::optional<input::CalibrationMatrix>& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (value->is_null()) return to.reset();
    input::CalibrationMatrix matrix{};
    if (!value->is_array() || value->size() != matrix.size()) return refuse(key);
    for (std::size_t k = 0; k < matrix.size(); ++k) {
      if (!(*value)[k].is_number()) return refuse(key);
      matrix[k] = (*value)[k].get<double>();
    }
    input::is_usable(matrix) ? void(to = matrix) : refuse(key);
  }

  [[nodiscard]] const std::optional<std::string>& wrong() const { return wrong_; }

 private:
  [[nodiscard]] const Json* find(const char* key) const {
    const auto at = from_.find(key);
    return at == from_.end() ? nullptr : &*at;
  }
  void refuse(const char* key) {
    if (!wrong_) wrong_ = key;
  }
  const Json& from_;
  std::optional<std::string> wrong_;
};

/// A descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = ::write(fd, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return true;
}

constexpr const char* discard_remedy = "it is left out; the dealer's next choice replaces it";

}  // namespace

std::filesystem::path choices_folder() {
  const char* folders = std::getenv("STATE_DIRECTORY");
  if (folders == nullptr) return {};
  const std::string_view all = folders;
  return all.substr(0, all.find(':'));
}

DealerChoices choices_of(const ExperienceSettings& settings) {
  return {settings.language, settings.beyond_allowed, settings.reduced_motion, settings.brightness, {}, settings.pin};
}

ExperienceSettings with_choices(ExperienceSettings settings, const DealerChoices& choices) {
  settings.language = choices.language;
  settings.beyond_allowed = choices.beyond_allowed;
  settings.reduced_motion = choices.reduced_motion;
  settings.brightness = choices.brightness;
  settings.calibration = choices.calibration;
  settings.pin = choices.pin;
  return settings;
}

std::string text_of(const DealerChoices& choices) {
  Json out{{language_key, word_of(choices.language)},
           {beyond_key, choices.beyond_allowed},
           {motion_key, choices.reduced_motion},
           {brightness_key, choices.brightness},
           {calibration_key, nullptr},
           {pin_wrong_key, choices.pin.wrong},
           {pin_lock_key, choices.pin.lock_s},
           {pin_until_key, choices.pin.locked_until_s}};
  if (choices.calibration) out[calibration_key] = *choices.calibration;
  return out.dump(2) + "\n";
}

Result<DealerChoices> parse_choices(const std::string& text, const std::string& file, const DealerChoices& defaults) {
  if (text.size() > max_choices_bytes) return fail(file, "", "is too long for what it may hold", discard_remedy);
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return fail(file, "", "is damaged: no JSON object", discard_remedy);
  DealerChoices out = defaults;
  Reader reader(json);
  reader.take(language_key, out.language);
  reader.take(beyond_key, out.beyond_allowed);
  reader.take(motion_key, out.reduced_motion);
  reader.take(brightness_key, out.brightness, least_brightness, most_brightness);
  reader.take(calibration_key, out.calibration);
  reader.take(pin_wrong_key, out.pin.wrong, 0, pin_attempts - 1);
  reader.take(pin_lock_key, out.pin.lock_s, 0.0, longest_lock_s);
  reader.take(pin_until_key, out.pin.locked_until_s, 0.0, most_wall_s);
  if (reader.wrong()) return fail(file, *reader.wrong(), "is not a value it can have", discard_remedy);
  return out;
}

Result<std::optional<DealerChoices>> read_choices(const std::filesystem::path& folder, const DealerChoices& defaults) {
  const std::string file = (folder / choices_file).string();
  // O_NONBLOCK: a FIFO in its place must not stop the kiosk.
  const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) {
    if (errno == ENOENT) return std::optional<DealerChoices>{};
    return fail(file, "", std::string("cannot be read: ") + std::strerror(errno), discard_remedy);
  }
  std::string text(max_choices_bytes + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = ::read(fd.get(), text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(file, "", std::string("cannot be read: ") + std::strerror(errno), discard_remedy);
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  text.resize(size);
  auto choices = parse_choices(text, file, defaults);
  if (!choices) return tl::unexpected(std::move(choices.error()));
  return std::optional(*choices);
}

Result<void> write_choices(const std::filesystem::path& folder, const DealerChoices& choices) {
  const std::string file = (folder / choices_file).string();
  const std::string fresh = file + ".new";
  const auto failed = [&](const char* step) {
    const std::string why = std::strerror(errno);
    ::unlink(fresh.c_str());
    return fail(file, "", std::string(step) + ": " + why, "make the folder writable for the kiosk's user");
  };
  {
    const Descriptor fd(::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (fd.get() < 0) return failed("cannot be written");
    if (!write_all(fd.get(), text_of(choices)) || ::fsync(fd.get()) != 0) return failed("cannot be written");
  }
  if (::rename(fresh.c_str(), file.c_str()) != 0) return failed("cannot be replaced");
  // The new name is on the disk only when the folder is.
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() < 0 || ::fsync(directory.get()) != 0)
    return fail(file, "", std::string("is written, but its folder cannot be synced: ") + std::strerror(errno),
                "check the file system");
  return {};
}

}  // namespace lackwerk::kiosk
