# Writes OUTPUT, a C++ source that holds the text of each of FILES: kStyle for the css file, kScript
# for all js files one after another.
set(style "")
set(script "")
foreach(path IN LISTS FILES)
  file(READ "${path}" text)
  if(path MATCHES "\\.css$")
    string(APPEND style "R\"PAGE(${text})PAGE\"\n")
  else()
    string(APPEND script "R\"PAGE(${text})PAGE\"\n")
  endif()
endforeach()
file(WRITE "${OUTPUT}" "#include \"tools/report/page_content.h\"

namespace lodemark {

const char* const kPageStyle =
${style};

const char* const kPageScript =
${script};

}  // namespace lodemark
")
