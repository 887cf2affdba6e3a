# page_literals(<variable> <function> <file>...): sets the variable to the name of a source with the function
# sampled_data_observers::page_parts::<function>(), which returns the texts of files below src/page/, one after the other.
# So programs need no files beside them. A literal for each file: longer ones than 65536 characters need not be compiled.
function(page_literals SOURCE FUNCTION)
  set(TEXTS)
  foreach(FILE ${ARGN})
    set(PATH ${PROJECT_SOURCE_DIR}/src/page/${FILE})
    file(READ ${PATH} TEXT)
    string(APPEND TEXTS "  text += R\"PAGE(${TEXT})PAGE\";\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PATH})
  endforeach()
  set(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/page_${FUNCTION}.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/page_literals.cpp.in ${OUTPUT} @ONLY)
  set(${SOURCE} ${OUTPUT} PARENT_SCOPE)
endfunction()
