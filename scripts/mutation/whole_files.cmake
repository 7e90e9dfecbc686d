# Included by scripts/mutation/base.py: what is mutated is compiled file by file.
cmake_language(DEFER CALL set_target_properties mien_animation PROPERTIES UNITY_BUILD OFF)
