// Programs that the library is a part of may have a locale in which a half is 0,5: MIEN_TEST_LOCALE
// names one that all tests run in.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <locale>

namespace {

class LocaleOfTheProgram : public testing::Environment {
 public:
  void SetUp() override {
    if (const char* name = std::getenv("MIEN_TEST_LOCALE"); name != nullptr) {
      std::locale::global(std::locale(name));  // C's, too
      ASSERT_STREQ(std::localeconv()->decimal_point, ",") << name;
    }
  }
};

const testing::Environment* const registered =
    testing::AddGlobalTestEnvironment(new LocaleOfTheProgram);

}  // namespace
