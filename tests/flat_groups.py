"""Each group of an archive as a flat file, with the coordinates that it inherits from the root."""

from pathlib import Path

import netCDF4


def write_flat_groups(path, folder):
    """Write the root and every group of an archive as files of their own; return their paths."""
    made = []
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        root = dict(file.variables)
        for name, group in {"root": file, **file.groups}.items():
            group.set_auto_maskandscale(False)
            own = dict(group.variables)
            used = {dim for variable in own.values() for dim in variable.dimensions}
            inherited = {dim: root[dim] for dim in used & set(root) - set(own)}
            listed = {
                one for row in own.values() for one in getattr(row, "coordinates", "").split()
            }
            inherited |= {one: root[one] for one in listed - set(own)}
            bounds = [getattr(one, "bounds", "") for one in inherited.values()]
            inherited |= {one: root[one] for one in bounds if one}
            flat = Path(folder) / f"{Path(path).stem}.{name}.nc"
            _write(flat, {**inherited, **own}, file)
            made.append(flat)
    return made


def _write(path, variables, file):
    with netCDF4.Dataset(path, "w") as flat:
        flat.setncatts({key: file.getncattr(key) for key in file.ncattrs()})
        for name, variable in variables.items():
            for dim, size in zip(variable.dimensions, variable.shape, strict=True):
                if dim not in flat.dimensions:
                    flat.createDimension(dim, size)
            attributes = {key: variable.getncattr(key) for key in variable.ncattrs()}
            fill = attributes.pop("_FillValue", None)
            copy = flat.createVariable(name, variable.dtype, variable.dimensions, fill_value=fill)
            copy.set_auto_maskandscale(False)
            copy.set_auto_chartostring(False)
            variable.set_auto_chartostring(False)
            copy.setncatts(attributes)
            copy[...] = variable[...]
