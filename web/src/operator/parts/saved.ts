/** Has the browser save a file under this name. */
export function saved(file: Blob, name: string): void {
  const address = URL.createObjectURL(file);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  // The browser has taken it by then; a large one is read from the disk, not from here.
  setTimeout(() => {
    URL.revokeObjectURL(address);
  }, 60_000);
}
