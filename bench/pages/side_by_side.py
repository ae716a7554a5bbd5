#!/usr/bin/python3
"""Puts pictures beside each other: side_by_side.py OUT.png IN.png ... Needs python3-vtk9."""
import sys

import vtk

beside = vtk.vtkImageAppend()
readers = [vtk.vtkPNGReader() for _ in sys.argv[2:]]
for reader, file in zip(readers, sys.argv[2:]):
    reader.SetFileName(file)
    beside.AddInputConnection(reader.GetOutputPort())
writer = vtk.vtkPNGWriter()
writer.SetFileName(sys.argv[1])
writer.SetInputConnection(beside.GetOutputPort())
writer.Write()
