/** Lets the browser save a file under this name. */
export function saved(file: Blob, name: string): void {
  const address = URL.createObjectURL(file);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  // The browser holds the file by then; a large one is read from disk.
  setTimeout(() => {
    URL.revokeObjectURL(address);
  }, 60_000);
}
