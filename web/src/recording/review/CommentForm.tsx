import { Button, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postRecordingsByNameComments } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { clockDuration } from "../recordingText";

const MAX_LENGTH = 500;

interface CommentFormProps {
  name: string;
  atS: number;
  onWritten: () => void;
}

/** Form for a comment on the displayed instant. */
export function CommentForm({ name, atS, onWritten }: CommentFormProps): ReactNode {
  const own = useTexts().recording.review.comment;
  const [text, setText] = useState("");
  const doing = useAction();
  const write = async (): Promise<void> => {
    const isWritten = await doing.run(async () => {
      const path = { name };
      await postRecordingsByNameComments({ path, body: { at_s: atS, text: text.trim() } });
    });
    if (!isWritten) return;
    setText("");
    onWritten();
  };
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (text.trim() !== "") void write();
      }}
    >
      <div className="review-comment">
        <TextInput
          size="lg"
          label={own.label}
          value={text}
          maxLength={MAX_LENGTH}
          data-testid="review-comment"
          onChange={(event) => {
            setText(event.currentTarget.value);
          }}
        />
        <Button
          size="lg"
          type="submit"
          variant="default"
          loading={doing.busy}
          disabled={text.trim() === ""}
          data-testid="review-comment-write"
        >
          {interpolate(own.write, { time: clockDuration(atS) })}
        </Button>
      </div>
      <RejectionNote rejection={doing.rejection} />
    </form>
  );
}
