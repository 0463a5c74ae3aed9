#!/usr/bin/python3
"""Reads .vtp files, or the collections (.pvd) that name them, with VTK's own reader and prints what
they hold as text: the independent reader of the tests. Status 77 where VTK is not installed."""
import os
import sys
import xml.etree.ElementTree as ElementTree

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    sys.exit(77)


def rows(array):
    for i in range(array.GetNumberOfTuples()):
        yield " ".join(repr(x) for x in array.GetTuple(i))


def show_arrays(title, data):
    for i in range(data.GetNumberOfArrays()):
        array = data.GetArray(i)
        print(title, array.GetName(), array.GetDataTypeAsString(), array.GetNumberOfComponents())
        for row in rows(array):
            print(" ", row)


def show_vtp(path):
    reader = vtkXMLPolyDataReader()
    if not reader.CanReadFile(path):
        sys.exit(path + ": VTK cannot read it")
    reader.SetFileName(path)
    reader.Update()
    if reader.GetErrorCode() != 0:
        sys.exit(path + ": VTK found an error")
    data = reader.GetOutput()
    print("points", data.GetNumberOfPoints())
    for i in range(data.GetNumberOfPoints()):
        print(" ", " ".join(repr(x) for x in data.GetPoint(i)))
    print("verts", data.GetNumberOfVerts(), "lines", data.GetNumberOfLines(), "polys",
          data.GetNumberOfPolys())
    for i in range(data.GetNumberOfCells()):
        cell = data.GetCell(i)
        print(" ", " ".join(str(cell.GetPointId(k)) for k in range(cell.GetNumberOfPoints())))
    show_arrays("point array", data.GetPointData())
    show_arrays("cell array", data.GetCellData())


def show_pvd(path):
    for entry in ElementTree.parse(path).getroot().find("Collection"):
        print("at", entry.get("timestep"), entry.get("part"), entry.get("file"))
        show_vtp(os.path.join(os.path.dirname(path), entry.get("file")))


for name in sys.argv[1:]:
    show_pvd(name) if name.endswith(".pvd") else show_vtp(name)
