// Commands to a simulated device: one line each, written to a FIFO by whoever likes.
//
// Why it exists: a uhid or uinput device lives as long as the process that made it, so the process must stay and be
// told. The FIFO appears when the device does: its existence says "ready". One thread.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <istream>
#include <sstream>
#include <string>

namespace vm {

class CommandFifo {
 public:
  explicit CommandFifo(std::string path) : path_(std::move(path)) {
    unlink(path_.c_str());
    if (mkfifo(path_.c_str(), 0600) != 0) return;
    // Opened for writing too: the reader never sees an end of file when a writer leaves.
    fd_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  }
  ~CommandFifo() {
    if (fd_ >= 0) close(fd_);
    unlink(path_.c_str());
  }
  CommandFifo(const CommandFifo&) = delete;
  CommandFifo& operator=(const CommandFifo&) = delete;

  [[nodiscard]] bool good() const { return fd_ >= 0; }
  /// To poll for reading.
  [[nodiscard]] int descriptor() const { return fd_; }

  /// Blocks for the next line.
  std::istringstream next() {
    std::string line;
    for (char c = 0; read(fd_, &c, 1) == 1 && c != '\n';) line += c;
    return std::istringstream(line);
  }

 private:
  std::string path_;
  int fd_ = -1;
};

}  // namespace vm
