// The dealer's PIN: hashed with its own salt, and refused in every form that is not one.
#include "kiosk/display/pin.hpp"

#include <gtest/gtest.h>

namespace lackwerk::kiosk {
namespace {

TEST(Pin, OpensWithItsDigitsAndNoOthers) {
  const auto hash = hash_pin("4711");
  ASSERT_TRUE(hash) << hash.error().line();
  EXPECT_TRUE(is_pin_hash(*hash)) << *hash;
  EXPECT_TRUE(check_pin(*hash, "4711"));
  for (const char* wrong : {"4712", "3711", "471", "47110", "04711", "", "471l", "4711\n"})
    EXPECT_FALSE(check_pin(*hash, wrong)) << wrong;
  EXPECT_EQ(hash->find("4711"), std::string::npos) << "salt and tag are base64: a chance of 1 in a million";
}

TEST(Pin, EachHashHasItsOwnSalt) {
  const auto one = hash_pin("123456789012"), two = hash_pin("123456789012");
  ASSERT_TRUE(one && two);
  EXPECT_NE(*one, *two);
  EXPECT_TRUE(check_pin(*one, "123456789012"));
  EXPECT_TRUE(check_pin(*two, "123456789012"));
}

TEST(Pin, CostsWhatTheHeaderSays) {
  const auto hash = hash_pin("0000");
  ASSERT_TRUE(hash);
  EXPECT_TRUE(hash->starts_with("$argon2id$v=19$m=8192,t=4,p=1$")) << *hash;
  EXPECT_LE(hash_memory_bytes, std::size_t{16} << 20);
}

TEST(Pin, OnlyDigitsAreHashed) {
  for (const char* wrong : {"", "123", "1234567890123", "12a4", "12 4", "-123", "\xd9\xa1\xd9\xa2\xd9\xa3\xd9\xa4"}) {
    const auto hash = hash_pin(wrong);
    ASSERT_FALSE(hash) << wrong;
    EXPECT_EQ(hash.error().kind, ErrorKind::usage);
  }
}

TEST(Pin, OtherTextsAreNoHashes) {
  const auto hash = hash_pin("1234");
  ASSERT_TRUE(hash);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = *hash;
    return text.replace(text.find(from), from.size(), to);
  };
  for (const std::string& text :
       {std::string(), std::string("1234"), hash->substr(0, hash->size() - 1), *hash + "A", *hash + "$",
        hash->substr(1), with("m=8192", "m=4294967295"), with("m=8192", "m=99999999999999999999"),
        with("m=8192", "m=16385"), with("m=8192", "m=0"), with("m=8192", "m=-1"), with("t=4", "t=9"), with("t=4", "t="),
        with("p=1", "p=2"), with("id", "i"), with("v=19", "v=16"), std::string(10'000, '$')}) {
    EXPECT_FALSE(is_pin_hash(text)) << text;
    EXPECT_FALSE(check_pin(text, "1234")) << text;
  }
}

TEST(Pin, ALineTypedGivesTheLineOfTheFile) {
  for (const char* typed : {"1234", "1234\n", "1234\r\n"}) {
    const auto line = pin_line(typed);
    ASSERT_TRUE(line) << line.error().line();
    ASSERT_TRUE(line->starts_with("pin = \"$argon2id$") && line->ends_with("\"\n")) << *line;
    const std::string hash = line->substr(7, line->size() - 9);
    EXPECT_TRUE(check_pin(hash, "1234"));
  }
  EXPECT_FALSE(pin_line("1234\n\n"));
  EXPECT_FALSE(pin_line("\n"));
}

}  // namespace
}  // namespace lackwerk::kiosk
