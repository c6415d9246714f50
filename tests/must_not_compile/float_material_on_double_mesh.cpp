// A float material on a double mesh is a mistake of types.
// expect: (no matching|cannot convert|could not convert|no known conversion)
#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

using FloatField = softtissue::UniformField<softtissue::StableNeoHookean<float>>;

softtissue::ElasticEnergy<softtissue::Tet4, FloatField> use(const softtissue::CellMesh<softtissue::Tet4, double>& mesh,
                                                            const FloatField& field) {
    return {mesh, field};
}
