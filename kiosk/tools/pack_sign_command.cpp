#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include <termios.h>
#include <unistd.h>

#include "kiosk/tools/commands.hpp"
#include "kiosk/tools/output.hpp"
#include "packs/minisign.hpp"
#include "packs/signed_pack.hpp"
#include "packs/small_file.hpp"
#include "packs/storage.hpp"

namespace lackwerk::tools {
namespace {

struct SignOptions {
  std::string pack, secret, out;
  bool json = false;
};

constexpr std::size_t max_password = 1024;

/// A line from standard input; not echoed where that is a terminal. What is longer than any password is cut.
std::string read_password() {
  termios before{};
  const bool terminal = ::isatty(STDIN_FILENO) != 0 && ::tcgetattr(STDIN_FILENO, &before) == 0;
  if (terminal) {
    std::fputs("Password of the key: ", stderr);
    termios silent = before;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &silent);
  }
  std::string line;
  for (int c = std::getchar(); c != EOF && c != '\n' && line.size() < max_password; c = std::getchar())
    line += static_cast<char>(c);
  if (terminal) {
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before);
    std::fputs("\n", stderr);
  }
  return line;
}

Result<packs::SecretKey> open_key(const std::string& path) {
  const auto text = packs::read_small_file(path, packs::max_minisig_bytes);
  if (!text) return tl::unexpected(text.error());
  return packs::SecretKey::parse(*text, packs::SecretKey::is_locked(*text) ? read_password() : std::string(), path);
}

/// Replaces a file in one step.
Result<void> write_whole(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const auto disk = packs::open_disk(folder);
  const std::string name = path.filename().string(), temporary = "." + name + "." + std::to_string(::getpid());
  auto writer = disk->create(temporary);
  if (!writer) return tl::unexpected(writer.error());
  auto done = (*writer)->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (done) done = (*writer)->sync();
  if (done) done = disk->rename(temporary, name);
  if (!done) {
    [[maybe_unused]] const auto removed = disk->remove_file(temporary);
    return done;
  }
  return disk->sync_folder("");
}

int run_sign(const SignOptions& options) {
  auto source = packs::open_source(options.pack);
  if (!source) return report(source.error());
  auto bytes = packs::read_source(**source, packs::max_exhibit_bytes, options.pack);
  if (!bytes) return report(bytes.error());
  packs::FileHash hash;
  hash.add(*bytes);
  // What is no sound pack is not signed: the signature's comment says what the content says.
  const auto self = packs::check_pack(std::move(*bytes), options.pack);
  if (!self) return report(self.error());
  const auto key = open_key(options.secret);
  if (!key) return report(key.error());
  const std::string comment = packs::trusted_comment(self->id, self->serial);
  const std::string out = options.out.empty() ? packs::signature_path(options.pack).string() : options.out;
  if (auto written = write_whole(out, packs::signature_text(key->sign(hash.finish(), comment))); !written)
    return report(written.error());
  if (options.json)
    print(nlohmann::ordered_json{{"file", options.pack},
                                 {"signature", out},
                                 {"id", self->id},
                                 {"serial", self->serial},
                                 {"key", packs::key_id_text(key->id())}}
              .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  else
    print(out + ": " + comment + ", key " + packs::key_id_text(key->id()));
  return exit_done;
}

}  // namespace

void add_pack_sign_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SignOptions>();
  CLI::App* command = command_group(app, "pack", "Paint packs")
                          .add_subcommand("sign", "Sign a paint pack with a minisign key (make one: minisign -G)");
  command->add_option("PACK", options->pack, "paint pack")->required();
  command
      ->add_option("--secret", options->secret,
                   "secret key file; its password, if it has one, is read from the terminal or standard input")
      ->required();
  command->add_option("-o,--out", options->out, "signature to write; PACK.minisig if not given");
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options, &exit_code] { exit_code = run_sign(*options); });
}

}  // namespace lackwerk::tools
