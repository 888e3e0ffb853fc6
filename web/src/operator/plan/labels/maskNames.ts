// A single mask of TotalSegmentator is named by its file, which an upload does not transfer.

/** Names for the request: `1:L3` for `vertebrae_L3.nii.gz`, empty for any other file. */
export function namesOf(files: readonly { name: string }[]): string {
  const [only] = files;
  if (only === undefined || files.length > 1) return "";
  const level = /^vertebrae_([CTLS]\d{1,2})\.nii(\.gz)?$/.exec(only.name)?.[1];
  return level === undefined ? "" : `1:${level}`;
}
