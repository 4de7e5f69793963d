// The guest's end of the command channel: runs what the host asks for, as root, one command at a time.
//
// Why it exists: a login shell on a console cannot tell output from prompts, nor say exit codes, and dies with its
// terminal. Here every request and every answer is framed by byte counts:
//   request  "ID TIMEOUT_MS COMMAND_BYTES INPUT_BYTES\n" command input
//   answer   "ID CODE OUT_BYTES ERR_BYTES\n" stdout stderr
// CODE is the exit code, 128 + signal, or -1 when the time was up and the command was killed. Lines that are no request
// are skipped, so that a host which connects late falls into step. Output goes to files, not pipes: a command may leave
// a process behind that holds its descriptors.
// Usage: agent [PORT_NAME]
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

constexpr long most_bytes = 64L << 20;  // of a command, its input or its output
constexpr int step_ms = 5;              // how often a running command is looked at

/// The device node of the virtio port with this name; empty while there is none.
std::string port_node(const std::string& name) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/virtio-ports", ignored)) {
    std::string found;
    std::getline(std::ifstream(entry.path() / "name"), found);
    if (found == name) return "/dev/" + entry.path().filename().string();
  }
  return {};
}

int open_port(const std::string& name) {
  for (;; usleep(50'000)) {
    const std::string node = port_node(name);
    if (node.empty()) continue;
    const int fd = open(node.c_str(), O_RDWR | O_CLOEXEC);
    if (fd >= 0) return fd;
  }
}

/// Blocks until `count` bytes are there. A port without a host reads as empty: wait for one.
std::string read_bytes(int port, long count) {
  std::string bytes(static_cast<std::size_t>(count), '\0');
  long done = 0;
  while (done < count) {
    const ssize_t got = read(port, bytes.data() + done, static_cast<std::size_t>(count - done));
    if (got > 0)
      done += got;
    else
      usleep(20'000);
  }
  return bytes;
}

std::string read_line(int port) {
  std::string line;
  for (std::string c = read_bytes(port, 1); c != "\n"; c = read_bytes(port, 1))
    if (line.size() < 200) line += c;
  return line;
}

void write_bytes(int port, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t wrote = write(port, bytes.data() + done, bytes.size() - done);
    if (wrote > 0)
      done += static_cast<std::size_t>(wrote);
    else
      usleep(20'000);
  }
}

/// A file without a name, in memory.
int scratch_file(const std::string& content = {}) {
  const int fd = open("/dev/shm", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (fd < 0) std::abort();
  write_bytes(fd, content);
  lseek(fd, 0, SEEK_SET);
  return fd;
}

std::string take_file(int fd) {
  struct stat status {};
  fstat(fd, &status);
  std::string bytes(static_cast<std::size_t>(std::min<long>(status.st_size, most_bytes)), '\0');
  const ssize_t got = pread(fd, bytes.data(), bytes.size(), 0);
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  close(fd);
  return bytes;
}

double now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

int wait_for(pid_t child, double timeout_ms) {
  const double until = now_ms() + timeout_ms;
  for (int status = 0;; usleep(step_ms * 1000)) {
    const bool late = now_ms() >= until;
    if (late) kill(-child, SIGKILL);
    if (waitpid(child, &status, late ? 0 : WNOHANG) == child) {
      if (late) return -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int port = open_port(argc > 1 ? argv[1] : "lackwerk.agent");
  for (;;) {
    long id = 0, timeout_ms = 0, command_bytes = 0, input_bytes = 0;
    const std::string line = read_line(port);
    // NOLINTNEXTLINE(cert-err34-c): all four must be numbers, and the ranges are checked below
    if (std::sscanf(line.c_str(), "%ld %ld %ld %ld", &id, &timeout_ms, &command_bytes, &input_bytes) != 4) continue;
    if (command_bytes < 0 || command_bytes > most_bytes || input_bytes < 0 || input_bytes > most_bytes) continue;
    const std::string command = read_bytes(port, command_bytes);
    const int in = scratch_file(read_bytes(port, input_bytes));
    const int out = scratch_file();
    const int err = scratch_file();
    const pid_t child = fork();
    if (child == 0) {
      setpgid(0, 0);
      dup2(in, 0);
      dup2(out, 1);
      dup2(err, 2);
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    if (child > 0) setpgid(child, child);
    const int code = child > 0 ? wait_for(child, static_cast<double>(timeout_ms)) : 126;
    close(in);
    const std::string said = take_file(out);
    const std::string complained = take_file(err);
    char head[100];
    std::snprintf(head, sizeof head, "%ld %d %zu %zu\n", id, code, said.size(), complained.size());
    write_bytes(port, head);
    write_bytes(port, said);
    write_bytes(port, complained);
  }
}
