// Host programs may use a locale with decimal commas: all tests run in the locale of
// MIEN_TEST_LOCALE. A C library without locales (musl) ends the program with 77, which CTest
// reports as skipped.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <locale>

namespace {

class LocaleOfTheProgram : public testing::Environment {
 public:
  void SetUp() override {
    if (const char* name = std::getenv("MIEN_TEST_LOCALE"); name != nullptr) {
      std::locale::global(std::locale(name));  // also that of C
#ifndef __GLIBC__
      if (std::strcmp(std::localeconv()->decimal_point, ".") == 0) {
        std::puts("skipped: this C library writes a half as 0.5 in every locale");
        std::exit(77);
      }
#endif
      ASSERT_STREQ(std::localeconv()->decimal_point, ",") << name;
    }
  }
};

const testing::Environment* const registered =
    testing::AddGlobalTestEnvironment(new LocaleOfTheProgram);

}  // namespace
