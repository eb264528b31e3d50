# The folders whose headers are public: installed, and described in the site's API.
list(TRANSFORM TREMIE_APPARATUS PREPEND apparatus/ OUTPUT_VARIABLE TREMIE_PUBLIC_FOLDERS)
list(PREPEND TREMIE_PUBLIC_FOLDERS libmpm rheometer apparatus/common apparatus/parts apparatus/registry apparatus/run apparatus/scene)
