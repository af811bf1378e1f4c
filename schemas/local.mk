# What scenes and results are, for programs that check them; `hr2d schema` prints them.
schemasdir = $(pkgdatadir)/schemas
dist_schemas_DATA = schemas/scene.json schemas/info.json schemas/solve.json \
	schemas/solve-mpi.json schemas/study.json schemas/cost.json schemas/factors.json \
	schemas/field.json
