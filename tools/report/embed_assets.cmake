# cmake -P: writes OUTPUT, a C++ source with the text of each file of INPUTS as a raw string, so
# that the program needs no files of its own at run time.
# The text of page.css is assets::page_css.
set(text "#include \"tools/report/assets.h\"\n\nnamespace hoof::tools::assets {\n\n")
foreach(input ${INPUTS})
  get_filename_component(name ${input} NAME)
  file(READ ${input} content)
  string(FIND "${content}" ")hoof_asset\"" delimiter_at)
  if(NOT delimiter_at EQUAL -1)
    message(FATAL_ERROR "${input} contains the delimiter of its raw string")
  endif()
  string(MAKE_C_IDENTIFIER "${name}" identifier)
  string(APPEND text "const std::string_view ${identifier} = R\"hoof_asset(${content})hoof_asset\";\n\n")
endforeach()
string(APPEND text "}  // namespace hoof::tools::assets\n")
file(WRITE ${OUTPUT} "${text}")
