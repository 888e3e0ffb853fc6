import { Button } from "@mantine/core";
import { useRef, type ReactNode } from "react";

interface FileButtonProps {
  accept: string;
  multiple?: boolean;
  disabled?: boolean;
  testId?: string;
  onFiles: (files: readonly File[]) => void;
  children: ReactNode;
}

/** A large file button; the same file can be chosen twice. */
export function FileButton(props: FileButtonProps): ReactNode {
  const { accept, multiple = false, disabled = false, testId, onFiles, children } = props;
  const input = useRef<HTMLInputElement>(null);
  return (
    <>
      <Button size="lg" variant="default" disabled={disabled} onClick={() => input.current?.click()}>
        {children}
      </Button>
      <input
        ref={input}
        type="file"
        hidden
        accept={accept}
        multiple={multiple}
        data-testid={testId}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (files.length > 0) onFiles(files);
        }}
      />
    </>
  );
}
