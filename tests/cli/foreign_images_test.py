"""Images as other programs write them: foreign_images_test.py OCTAFRONT. Debian's Python with nibabel, pydicom, meshio;
gdcmconv compresses. Voxels hold a linear function, which --sample must find at the nodes of a mesh in the same place."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import meshio
    import nibabel
    import numpy
    import pydicom
    from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
    from pydicom.sequence import Sequence
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

OCTAFRONT = sys.argv[1]
SIZE = (14, 12, 10)
# RAS: turned about the long axis of the patient, with unequal spacing.
AFFINE = numpy.array([[0, -1.5, 0, 40], [2, 0, 0, -7], [0, 0, 2.5, 11], [0, 0, 0, 1]])
GREY = (100 + 2 * numpy.arange(14)[:, None, None] + 3 * numpy.arange(12)[None, :, None]
        + 7 * numpy.arange(10)[None, None, :]).astype("int16")


def boxes(*filled):
    values = numpy.zeros(SIZE, "uint8")
    for label, lo, hi in filled:
        values[lo[0]:hi[0], lo[1]:hi[1], lo[2]:hi[2]] = label
    return values


LEFT, RIGHT = ((2, 2, 2), (6, 10, 8)), ((6, 2, 2), (12, 10, 8))


def volume_of(box):
    return float(numpy.prod(numpy.subtract(box[1], box[0]))) * abs(numpy.linalg.det(AFFINE))


def dicom_file(path, syntax="1.2.840.10008.1.2.1", sop="1.2.840.10008.5.1.4.1.1.2"):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = sop, pydicom.uid.generate_uid()
    meta.TransferSyntaxUID = syntax
    data = FileDataset(str(path), {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian, data.is_implicit_VR = True, False
    data.SOPClassUID, data.SOPInstanceUID = sop, meta.MediaStorageSOPInstanceUID
    data.StudyInstanceUID, data.SeriesInstanceUID = "1.2.3", "1.2.3.4"
    data.Rows, data.Columns = SIZE[1], SIZE[0]
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    return data


LPS = numpy.diag([-1.0, -1, 1, 1]) @ AFFINE
DIRECTIONS = [float(x) for axis in (0, 1) for x in LPS[:3, axis] / numpy.linalg.norm(LPS[:3, axis])]
SPACING = [float(numpy.linalg.norm(LPS[:3, axis])) for axis in (1, 0)]


def place_of(k):
    return [float(x) for x in (LPS @ [0, 0, k, 1])[:3]]


class ForeignImages(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)
        self.labels = self.dir / "labels.nii"
        nibabel.save(nibabel.Nifti1Image(boxes((1, *LEFT), (2, *RIGHT)), AFFINE), self.labels)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0):
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, status, f"{done.stdout}{done.stderr}")
        return done

    def volumes(self, *arguments):
        report = self.dir / "regions.json"
        self.run_cli("check", *arguments, "--json", report)
        return {r["name"]: r["volume"] for r in json.loads(report.read_text())["input_regions"]}

    def assert_has_grey(self, image, labels=None, affine=AFFINE):
        out = self.dir / "sampled.vtu"
        self.run_cli("mesh", labels or self.labels, "-o", out, "--size", 4, "--ascii", "--sample", f"{image}=HU")
        mesh = meshio.read(out)
        index = (numpy.linalg.inv(affine) @ numpy.c_[mesh.points, numpy.ones(len(mesh.points))].T)[:3]
        expected = 100 + 2 * index[0] + 3 * index[1] + 7 * index[2]
        self.assertGreater(len(expected), 50)
        numpy.testing.assert_allclose(mesh.point_data["HU"].ravel(), expected, atol=2e-3)

    def slices(self):
        folder = self.dir / "dicom"
        folder.mkdir()
        for k in range(SIZE[2]):
            data = dicom_file(folder / f"{k}.dcm")
            data.Modality, data.SeriesNumber, data.InstanceNumber = "CT", 1, SIZE[2] - k
            data.ImageOrientationPatient, data.ImagePositionPatient = DIRECTIONS, place_of(k)
            data.PixelSpacing = SPACING
            data.BitsAllocated, data.BitsStored, data.HighBit, data.PixelRepresentation = 16, 16, 15, 1
            data.RescaleSlope, data.RescaleIntercept = 0.5, -24
            data.PixelData = (2 * (GREY[:, :, k].T.astype(int) + 24)).astype("<i2").tobytes()
            data.save_as(folder / f"{k}.dcm", write_like_original=False)
        return folder

    def test_mgz(self):
        image = self.dir / "t1.mgz"
        nibabel.save(nibabel.MGHImage(GREY, AFFINE), image)
        self.assert_has_grey(image)
        nibabel.save(nibabel.MGHImage(GREY.astype("float32"), AFFINE), self.dir / "t1.mgh")
        self.assert_has_grey(self.dir / "t1.mgh")
        (self.dir / "cut.mgh").write_bytes((self.dir / "t1.mgh").read_bytes()[:2000])
        self.run_cli("check", self.dir / "cut.mgh", "--iso", 1, status=3)

    def test_labels_of_freesurfer(self):
        image, table = self.dir / "aseg.mgz", self.dir / "lut.txt"
        nibabel.save(nibabel.MGHImage(boxes((17, *LEFT), (53, *RIGHT)), AFFINE), image)
        table.write_text("#No. Label Name:          R   G   B   A\n0   Unknown                0   0   0   0\n"
                         "17  Left-Hippocampus       220 216 20  0\n53  Right-Hippocampus      220 216 20  0\n")
        self.assertEqual(list(self.volumes(image, "--labels", table)), ["Left-Hippocampus", "Right-Hippocampus"])

    def test_dicom(self):
        self.assert_has_grey(self.slices())

    def test_compressed_dicom(self):
        if not shutil.which("gdcmconv"):
            self.skipTest("there is no gdcmconv")
        plain = self.slices()
        for flag in ("--jpeg", "--jpegls", "--j2k", "--rle", "--deflated"):
            with self.subTest(flag):
                folder = self.dir / flag.strip("-")
                folder.mkdir()
                for file in plain.iterdir():
                    subprocess.run(["gdcmconv", flag, file, folder / file.name], check=True, capture_output=True)
                first = pydicom.dcmread(next(folder.iterdir()))
                self.assertNotEqual(first.file_meta.TransferSyntaxUID, "1.2.840.10008.1.2.1")
                done = subprocess.run([OCTAFRONT, "info", folder], capture_output=True, text=True)
                if "libgdcm-dev" in done.stdout + done.stderr:
                    self.assertEqual(done.returncode, 3)  # of a build without
                    continue
                self.assert_has_grey(folder)
                cut = folder / "0.dcm"
                cut.write_bytes(cut.read_bytes()[:-150])
                self.assertIn("1 file was passed over", self.run_cli("info", folder).stdout)

    def test_segmentation_of_dicom(self):
        for bits in (1, 8):
            path = self.dir / f"seg{bits}.dcm"
            data = dicom_file(path, sop="1.2.840.10008.5.1.4.1.1.66.4")
            data.Modality, data.SegmentationType = "SEG", "BINARY" if bits == 1 else "FRACTIONAL"
            if bits == 8:
                data.MaximumFractionalValue = 200
            data.BitsAllocated, data.BitsStored, data.HighBit, data.PixelRepresentation = bits, bits, bits - 1, 0
            data.SegmentSequence = Sequence([Dataset(), Dataset()])
            for number, name in ((1, "left part"), (2, "right part")):
                segment = data.SegmentSequence[number - 1]
                segment.SegmentNumber, segment.SegmentLabel = number, name
            plane, measures, orientation = Dataset(), Dataset(), Dataset()
            measures.PixelSpacing, measures.SliceThickness = SPACING, 2.5
            orientation.ImageOrientationPatient = DIRECTIONS
            shared = Dataset()
            shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = Sequence([measures]), Sequence([orientation])
            data.SharedFunctionalGroupsSequence = Sequence([shared])
            frames, pixels = [], []
            for number, box in ((1, LEFT), (2, RIGHT)):
                mask = boxes((1, *box))
                for k in range(2, 8):  # frames of nothing are left out
                    frame, at, of = Dataset(), Dataset(), Dataset()
                    at.ImagePositionPatient, of.ReferencedSegmentNumber = place_of(k), number
                    frame.PlanePositionSequence, frame.SegmentIdentificationSequence = Sequence([at]), Sequence([of])
                    frames.append(frame)
                    pixels.append(mask[:, :, k].T.ravel())
            data.PerFrameFunctionalGroupsSequence = Sequence(frames)
            data.NumberOfFrames = len(frames)
            flat = numpy.concatenate(pixels)
            data.PixelData = numpy.packbits(flat, bitorder="little").tobytes() if bits == 1 else (flat * 120).tobytes()
            if len(data.PixelData) % 2:
                data.PixelData += b"\0"
            data.save_as(path, write_like_original=False)
            made = self.volumes(path)
            self.assertEqual(list(made), ["left part", "right part"])
            self.assertAlmostEqual(made["left part"] / volume_of(LEFT), 1, 3)
            self.assertAlmostEqual(made["right part"] / volume_of(RIGHT), 1, 3)
            self.assert_same_place(path)

    def assert_same_place(self, image):
        ours, theirs = (json.loads(self.run_cli("info", i, "--json", "-").stdout) for i in (image, self.labels))
        numpy.testing.assert_allclose(ours["axes"][:2], [[-a[0], -a[1], a[2]] for a in theirs["axes"][:2]], atol=1e-6)

    def test_masks(self):
        folder = self.dir / "masks"
        folder.mkdir()
        nibabel.save(nibabel.Nifti1Image(boxes((1, *LEFT)), AFFINE), folder / "kidney_left.nii.gz")
        nibabel.save(nibabel.Nifti1Image(boxes((255, *RIGHT)), AFFINE), folder / "liver.nii.gz")
        nibabel.save(nibabel.Nifti1Image(boxes(), AFFINE), folder / "spleen.nii.gz")
        for given in ([folder], [folder / "kidney_left.nii.gz", folder / "liver.nii.gz"]):
            made = self.volumes(*given)
            self.assertEqual(list(made), ["kidney_left", "liver"])
            self.assertAlmostEqual(made["liver"] / volume_of(RIGHT), 1, 3)
        self.assertIn("spleen", self.run_cli("check", folder).stdout)
        other = self.dir / "other.nii.gz"
        nibabel.save(nibabel.Nifti1Image(boxes((1, *LEFT)), 2 * AFFINE), other)
        self.assertIn("grid", self.run_cli("check", folder / "liver.nii.gz", other, status=3).stderr)

    def test_names_in_the_extension_of_nifti(self):
        image = nibabel.Nifti1Image(boxes((1, *LEFT), (2, *RIGHT)), AFFINE)
        text = ('<?xml version="1.0" encoding="UTF-8"?><CaretExtension><VolumeInformation Index="0"><LabelTable>'
                '<Label Key="1" Red="0.1" Green="0" Blue="0" Alpha="1"><![CDATA[spleen]]></Label>'
                '<Label Key="2" Red="0.1" Green="0" Blue="0" Alpha="1"><![CDATA[kidney_right]]></Label>'
                '</LabelTable></VolumeInformation></CaretExtension>')
        image.header.extensions.append(nibabel.nifti1.Nifti1Extension(0, text.encode()))
        nibabel.save(image, self.dir / "total.nii.gz")
        self.assertEqual(list(self.volumes(self.dir / "total.nii.gz")), ["spleen", "kidney_right"])

    def test_segments_in_layers(self):
        layers = numpy.stack([boxes((1, *LEFT)), boxes((1, (5, 2, 2), (12, 10, 8)))])
        header = ("NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 14 12 10\n"
                  "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\nencoding: raw\n"
                  "space origin: (0,0,0)\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=liver\n"
                  "Segment1_LabelValue:=1\nSegment1_Layer:=1\nSegment1_Name:=tumour\n\n")
        path = self.dir / "s.seg.nrrd"
        path.write_bytes(header.encode() + layers.ravel(order="F").tobytes())
        made = self.volumes(path)
        self.assertAlmostEqual(made["liver"] / (3 * 8 * 6), 1, 3)
        self.assertAlmostEqual(made["tumour"] / (7 * 8 * 6), 1, 3)
        self.assertIn("48 voxels are in several", self.run_cli("check", path).stdout)
        self.assertEqual(list(self.volumes(path, "--series", 1)), ["liver"])

    def test_arrays_of_numpy(self):
        labels = self.dir / "one.nii"
        nibabel.save(nibabel.Nifti1Image(boxes((1, *LEFT), (2, *RIGHT)), numpy.eye(4)), labels)
        for order in "CF":
            for kind in ("<i2", ">f8"):
                numpy.save(self.dir / "a.npy", numpy.asarray(GREY, order=order, dtype=kind))
                self.assert_has_grey(self.dir / "a.npy", labels, numpy.eye(4))
        numpy.save(self.dir / "flat.npy", GREY[:, :, 0])
        self.run_cli("info", self.dir / "flat.npy", status=3)

    def test_stacks_of_tiff(self):
        try:
            import tifffile
        except ImportError:
            self.skipTest("there is no tifffile")
        labels = self.dir / "one.nii"
        nibabel.save(nibabel.Nifti1Image(boxes((1, *LEFT), (2, *RIGHT)), numpy.eye(4)), labels)
        pages = numpy.ascontiguousarray(GREY.transpose(2, 1, 0))
        whole, folder = self.dir / "stack.tif", self.dir / "slices"
        folder.mkdir()
        for kind, how in (("int16", {}), (">i2", {}), ("float32", {"compression": "zlib"})):
            try:
                tifffile.imwrite(whole, pages.astype(kind), photometric="minisblack", **how)
            except (TypeError, ValueError, KeyError):
                continue
            if "libtiff-dev" in subprocess.run([OCTAFRONT, "info", whole], capture_output=True, text=True).stderr:
                self.skipTest("built without libtiff")
            self.assert_has_grey(whole, labels, numpy.eye(4))
        for k in range(len(pages)):
            tifffile.imwrite(folder / f"{k:03}.tif", pages[k], photometric="minisblack")
        self.assert_has_grey(folder, labels, numpy.eye(4))
        tifffile.imwrite(folder / "003.tif", pages[3][:5], photometric="minisblack")
        self.run_cli("info", folder, status=3)
        whole.write_bytes(whole.read_bytes()[:600])
        self.run_cli("info", whole, status=3)

    def test_labels_that_are_not_quite_whole(self):
        values = boxes((1, *LEFT), (2, *RIGHT)).astype("float32") * numpy.float32(0.99)
        nibabel.save(nibabel.Nifti1Image(values, AFFINE), self.dir / "f.nii")
        done = self.run_cli("check", self.dir / "f.nii", "--image", "labels")
        self.assertIn("rounded", done.stdout)
        self.assertEqual(list(self.volumes(self.dir / "f.nii", "--image", "labels")), ["label 1", "label 2"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
