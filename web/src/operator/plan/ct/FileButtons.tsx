import { Button } from "@mantine/core";
import { useRef, type ReactNode } from "react";

interface FileButtonsProps {
  texts: { file: string; folder?: string };
  accept?: string;
  disabled: boolean;
  onFiles: (files: readonly File[]) => void;
}

/** Chooses one file or a folder. */
export function FileButtons({ texts, accept, disabled, onFiles }: FileButtonsProps): ReactNode {
  const file = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const taken = (input: HTMLInputElement): void => {
    onFiles([...(input.files ?? [])]);
    // Reset, so that choosing the same file again is an event.
    input.value = "";
  };
  return (
    <div className="file-buttons">
      <input
        ref={file}
        type="file"
        hidden
        multiple={texts.folder !== undefined}
        accept={accept}
        data-testid="file-input"
        onChange={(event) => {
          taken(event.currentTarget);
        }}
      />
      <Button size="xl" disabled={disabled} onClick={() => file.current?.click()}>
        {texts.file}
      </Button>
      {texts.folder !== undefined && (
        <>
          <input
            ref={(input) => {
              folder.current = input;
              if (input !== null) input.webkitdirectory = true;
            }}
            type="file"
            hidden
            multiple
            data-testid="folder-input"
            onChange={(event) => {
              taken(event.currentTarget);
            }}
          />
          <Button size="xl" variant="default" disabled={disabled} onClick={() => folder.current?.click()}>
            {texts.folder}
          </Button>
        </>
      )}
    </div>
  );
}
