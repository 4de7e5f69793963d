// What the importer has left for the kiosk: news, old news, and things that only look like it.
#include "kiosk/display/import_notice.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/pack_samples.hpp"

namespace lackwerk::kiosk {
namespace {

using lackwerk::testing::TemporaryFolder;
using Outcome = ImportedFile::Outcome;

constexpr double start_s = 1'700'000'000.0;

ImportedFile file(std::string name, Outcome outcome, std::string text) {
  ImportedFile out;
  out.file = std::move(name);
  out.outcome = outcome;
  (outcome == Outcome::refused ? out.error : out.id) = std::move(text);
  out.serial = outcome == Outcome::refused ? 0 : 3;
  return out;
}

ImportReport report(double after_start_s) {
  ImportReport out;
  out.time_s = static_cast<std::int64_t>(start_s + after_start_s);
  out.files.push_back(file("old.lwp", Outcome::already_there, "demo.old"));
  out.files.push_back(file("rogue.lwp", Outcome::refused, "rogue.lwp: not signed (copy both files)"));
  out.files.push_back(file("spring.lwp", Outcome::stored, "demo.spring"));
  return out;
}

bool readable(int fd) {
  pollfd one{fd, POLLIN, 0};
  return ::poll(&one, 1, 0) == 1;
}

void expect_equal(const ImportReport& a, const ImportReport& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.error, b.error);
  ASSERT_EQ(a.files.size(), b.files.size());
  for (std::size_t k = 0; k < a.files.size(); ++k) {
    EXPECT_EQ(a.files[k].file, b.files[k].file);
    EXPECT_EQ(a.files[k].outcome, b.files[k].outcome);
    EXPECT_EQ(a.files[k].id, b.files[k].id);
    EXPECT_EQ(a.files[k].serial, b.files[k].serial);
    EXPECT_EQ(a.files[k].error, b.files[k].error);
  }
}

TEST(ImportNotice, ReadsWhatTheImporterWrites) {
  ImportReport written = report(0.0);
  written.error = "17 packs on the stick";
  const auto read = parse_import(import_json(written), "import.json");
  ASSERT_TRUE(read) << read.error().line();
  expect_equal(*read, written);
}

TEST(ImportNotice, NewsComeOnceAndTheOldIsKeptInSilence) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_import(folder.path(), report(-100.0)));
  ImportNotice notice(folder.path());
  auto polled = notice.poll(5000.0, start_s);
  ASSERT_TRUE(polled);
  EXPECT_FALSE(*polled) << "of before the kiosk's start";
  ASSERT_TRUE(notice.last());
  EXPECT_EQ(notice.last()->files.size(), 3u);

  EXPECT_FALSE(readable(notice.fd()));
  ASSERT_TRUE(write_import(folder.path(), report(20.0)));
  EXPECT_TRUE(readable(notice.fd())) << "wakes whoever polls";
  polled = notice.poll(26'000.0, start_s + 21.0);
  ASSERT_TRUE(polled && *polled);
  expect_equal(**polled, report(20.0));
  EXPECT_FALSE(readable(notice.fd()));
  polled = notice.poll(27'000.0, start_s + 22.0);
  EXPECT_TRUE(polled && !*polled) << "said once";
}

TEST(ImportNotice, OtherFilesOfTheFolderAreNone) {
  const TemporaryFolder folder;
  ImportNotice notice(folder.path());
  ASSERT_TRUE(notice.poll(0.0, start_s));
  std::ofstream(folder / "status.json.new") << import_json(report(1.0));
  std::filesystem::rename(folder / "status.json.new", folder / "status.json");
  const auto polled = notice.poll(1000.0, start_s + 1.0);
  EXPECT_TRUE(polled && !*polled);
  EXPECT_FALSE(notice.last());
}

TEST(ImportNotice, AClockThatIsSetMeanwhileHidesNothing) {
  for (const double step_s : {-86400.0 * 365.0, 86400.0 * 365.0}) {
    const TemporaryFolder folder;
    ImportNotice notice(folder.path());
    ASSERT_TRUE(notice.poll(0.0, start_s));
    ASSERT_TRUE(write_import(folder.path(), report(step_s + 30.0)));
    const auto polled = notice.poll(31'000.0, start_s + step_s + 31.0);
    EXPECT_TRUE(polled && *polled) << step_s;
  }
}

TEST(ImportNotice, WithoutAFolderNothingIsWatched) {
  const TemporaryFolder folder;
  for (const std::filesystem::path& none : {std::filesystem::path(), folder / "none"}) {
    ImportNotice notice(none);
    EXPECT_EQ(notice.fd(), -1);
    const auto polled = notice.poll(0.0, start_s);
    EXPECT_TRUE(polled && !*polled);
  }
}

TEST(ImportNotice, WhatIsNoneIsSaidOnceAndTheLastOneStays) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_import(folder.path(), report(0.0)));
  ImportNotice notice(folder.path());
  ASSERT_TRUE(notice.poll(0.0, start_s));
  const std::string many = [] {
    ImportReport out;
    out.files.resize(max_import_files + 1);
    return import_json(out);
  }();
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("null"), std::string("\xff"),
        std::string(max_import_bytes, '['), std::string(max_import_bytes + 1, ' '), std::string(R"({"time_s": "now"})"),
        std::string(R"({"time_s": -1})"), std::string(R"({"time_s": 1e30})"),
        std::string(R"({"time_s": 18446744073709551615})"), std::string(R"({"error": 1})"),
        std::string(R"({"files": {}})"), std::string(R"({"files": [1]})"), std::string(R"({"files": [{}]})"),
        std::string(R"({"files": [{"result": "perhaps"}]})"),
        std::string(R"({"files": [{"result": "stored", "id": []}]})"),
        std::string(R"({"files": [{"result": "stored", "serial": -3}]})"), many}) {
    std::ofstream(folder / "fresh") << text;
    std::filesystem::rename(folder / "fresh", folder / import_file_name);
    const auto polled = notice.poll(1000.0, start_s);
    ASSERT_FALSE(polled) << text.substr(0, 60);
    EXPECT_NE(polled.error().line().find(import_file_name), std::string::npos);
    EXPECT_TRUE(notice.poll(1000.0, start_s)) << "said once";
    ASSERT_TRUE(notice.last());
    EXPECT_EQ(notice.last()->files.size(), 3u);
  }
  std::filesystem::remove(folder / import_file_name);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::rename(folder / "pipe", folder / import_file_name);
  EXPECT_FALSE(notice.poll(1000.0, start_s)) << "returns, and does not wait for a writer";
}

TEST(ImportNotice, HostileNamesStayShortAndInTheirPlace) {
  ImportReport written;
  written.files.push_back(file("a\nb\x1b[2J\u202Egnp.\u2067exe\u200F", Outcome::refused, std::string(5000, 'x')));
  std::string wide;
  for (int k = 0; k < 300; ++k) wide += "ß";
  written.files.push_back(file("x.lwp", Outcome::refused, "y" + wide));
  const auto read = parse_import(import_json(written), "import.json");
  ASSERT_TRUE(read) << read.error().line();
  EXPECT_EQ(read->files[0].file, "a?b?[2J?gnp.?exe?");
  EXPECT_EQ(read->files[0].error.size(), max_import_text_bytes);
  EXPECT_EQ(read->files[1].error.size(), max_import_text_bytes - 1) << "cut between letters";
}

TEST(ImportNotice, AToastSaysWhatCame) {
  ImportReport both = report(0.0);
  both.files.push_back(file("worse.lwp", Outcome::refused, "worse.lwp: digest"));
  ui::Toast toast = toast_of(both);
  EXPECT_EQ(toast.stored, std::vector<std::string>{"demo.spring"});
  EXPECT_EQ(toast.known, std::vector<std::string>{"demo.old"});
  EXPECT_EQ(toast.refused, 2);
  EXPECT_EQ(toast.reason, "rogue.lwp: not signed (copy both files)");
  ImportReport none;
  none.error = "lackwerk: no such folder on the stick";
  toast = toast_of(none);
  EXPECT_EQ(toast.refused, 0);
  EXPECT_EQ(toast.reason, none.error);
}

}  // namespace
}  // namespace lackwerk::kiosk
