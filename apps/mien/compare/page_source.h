// The page before its data: page.html with page.css and the scripts in it, put together by
// embed.cmake. The marks @DATA@ and @VIDEO@ are still in it.
#pragma once

namespace mien::app {

extern const char kPageSource[];

}  // namespace mien::app
