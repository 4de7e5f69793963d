#include "kiosk/display/ui/qr.hpp"

#include <qrencode.h>

#include <memory>

namespace lackwerk::kiosk::ui {

std::optional<QrCode> qr_of(const std::string& text) {
  if (text.empty() || text.find('\0') != std::string::npos) return std::nullopt;
  struct Free {
    void operator()(QRcode* code) const { QRcode_free(code); }
  };
  const std::unique_ptr<QRcode, Free> made(QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_M, QR_MODE_8, 1));
  if (!made) return std::nullopt;
  QrCode code;
  code.side = made->width;
  const std::size_t modules = static_cast<std::size_t>(made->width) * static_cast<std::size_t>(made->width);
  code.dark.reserve(modules);
  // The lowest bit is the colour; the others say what a module is for.
  for (std::size_t k = 0; k < modules; ++k) code.dark.push_back(made->data[k] & 1U);
  return code;
}

}  // namespace lackwerk::kiosk::ui
