// Style and script of the report page, made from the files in tools/report/page at build time.
#pragma once

namespace lodemark {

extern const char* const kPageStyle;
extern const char* const kPageScript;

}  // namespace lodemark
