// The seat of a seat manager: libseat, with a table of its functions so that tests can be the manager.
//
// Why it exists: libseat blocks while it opens a seat, knows no user data in its log handler, and speaks C. All of that
// stays in here. As seat.hpp says: one owner, one thread; while it opens, a second thread waits for the manager.
#pragma once

#include <cstdarg>
#include <memory>
#include <string>

#include "kiosk/display/output/seat.hpp"

struct libseat;                // from <libseat.h>, which only the source file needs
struct libseat_seat_listener;  //

namespace lackwerk::kiosk {

/// libseat.h's functions, under their names. All set.
struct LibseatCalls {
  libseat* (*open_seat)(const libseat_seat_listener*, void* userdata);
  int (*disable_seat)(libseat*);
  int (*close_seat)(libseat*);
  int (*open_device)(libseat*, const char* path, int* fd);
  int (*close_device)(libseat*, int device_id);
  const char* (*seat_name)(libseat*);
  int (*get_fd)(libseat*);
  int (*dispatch)(libseat*, int timeout_ms);
};
/// The library itself.
[[nodiscard]] const LibseatCalls& libseat_calls();

/// `backend`: "seatd", "logind", or as LIBSEAT_BACKEND takes it; empty: libseat chooses. Waits at most `wait_ms` for
/// the manager's answer, and as long again for it to make the seat active; a manager that answers later finds its seat
/// closed. Error: no answer, or refused, with what libseat said.
[[nodiscard]] Result<std::unique_ptr<Seat>> open_libseat(const LibseatCalls& calls, const std::string& backend,
                                                         int wait_ms, Log& log);

}  // namespace lackwerk::kiosk
