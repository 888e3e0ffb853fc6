export const labelsEn = {
  labels: {
    title: "Labels of the vertebrae",
    hint: "A segmentation of this CT by TotalSegmentator or another program shows the levels in the slices, counts them a second time, and measures both pedicles without a tap.",
    buttons: { file: "Choose segmentation", folder: "Choose folder" },
    cut: "cut by the border of the CT",
    show: "Show the labels in the slices",
    measureBoth: "Measure both pedicles",
  },
};
