# The registry: the apparatus that the program has. Each is a folder of apparatus/ with a library tremie_<name> and a
# function tremie::<name>::apparatus().
set(TREMIE_APPARATUS slump_flow l_box u_box lcpc_box j_ring v_funnel inverted_cone orimet bored_pile icar_vane cell)

# tremie_registry(FILE NAME...): writes the source of scene::all_apparatus() for these apparatus.
function(tremie_registry file)
  set(declared "")
  set(calls "")
  foreach(name ${ARGN})
    string(APPEND declared "namespace tremie::${name} {\nscene::Apparatus apparatus();\n}\n")
    list(APPEND calls "${name}::apparatus()")
  endforeach()
  list(JOIN calls ", " calls)
  configure_file(${PROJECT_SOURCE_DIR}/apparatus/registry/all_apparatus.cpp.in ${file} @ONLY)
endfunction()
