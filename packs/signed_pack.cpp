#include "packs/signed_pack.hpp"

#include "packs/small_file.hpp"

namespace lackwerk::packs {

std::filesystem::path signature_path(const std::filesystem::path& pack) { return pack.string() + ".minisig"; }

Result<PackSelf> check_pack(std::vector<std::uint8_t> bytes, const std::string& file) {
  const auto pack = ExhibitPack::from_bytes(std::move(bytes), file);
  if (!pack) return tl::unexpected(pack.error());
  return PackSelf{pack->id(), pack->serial()};
}

Result<OpenedPack> open_signed_pack(const std::filesystem::path& path, const Keyring& keyring, bool allow_unsigned) {
  const std::string file = path.string();
  auto source = open_source(path);
  if (!source) return tl::unexpected(source.error());
  auto bytes = read_source(**source, max_exhibit_bytes, file);
  if (!bytes) return tl::unexpected(bytes.error());
  std::optional<SignedAs> as;
  std::error_code code;
  const std::filesystem::path beside = signature_path(path);
  if (std::filesystem::exists(beside, code)) {
    const auto text = read_small_file(beside, max_minisig_bytes);
    if (!text) return tl::unexpected(text.error());
    FileHash hash;
    hash.add(*bytes);
    const auto checked = keyring.check(*text, hash.finish(), beside.string());
    if (!checked) return tl::unexpected(checked.error());
    as = *checked;
  } else if (!allow_unsigned) {
    return fail(file, "", "not signed", "put " + beside.filename().string() + " beside it, or allow unsigned packs");
  }
  auto pack = ExhibitPack::from_bytes(std::move(*bytes), file);
  if (!pack) return tl::unexpected(pack.error());
  if (as)
    if (auto same = check_signed_as(*as, pack->id(), pack->serial(), beside.string()); !same)
      return tl::unexpected(same.error());
  return OpenedPack{std::move(*pack), as};
}

}  // namespace lackwerk::packs
