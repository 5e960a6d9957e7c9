// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Replacing dead taxels of a bank's map: one frame at a time is kept back, each is read again whole and once, from its
// first reading to its last, and nothing waits for ever.
//
// Assumed: a frame begins only while none is kept back, its readings come after that, and Bz takes no frame that has not
// left.
module harness (
    input wire clock,
    input wire advance,
    input wire begins,
    input wire in_valid,
    input wire in_last,
    input wire take
);

    localparam TAXELS = 4;

    reg started = 1'b0;
    wire reset = !started;
    wire hold;
    wire out_valid;
    wire out_last;
    wire [2:0] place;
    wire [2:0] ends_at;
    wire [2:1] settles;
    wire pending;
    wire replays;
    wire [2:0] replay_place;
    wire [2:0] replay_end;
    wire holds;
    wire start;
    wire valid_1;
    wire [4:2] valid;
    wire [4:1] lasts;
    wire [2:0] newest;
    wire [2:0] oldest;

    sptfra_replace subject (
        .clock         (clock),
        .reset         (reset),
        .advance       (advance),
        .begins        (begins),
        .hold          (hold),
        .in_valid      (in_valid),
        .in_last       (in_last),
        .out_valid     (out_valid),
        .out_last      (out_last),
        .replaced_take (take),
        // Inside
        .place         (place),
        .ends_at       (ends_at),
        .settles       (settles),
        .pending       (pending),
        .replays       (replays),
        .replay_place  (replay_place),
        .replay_end    (replay_end),
        .holds         (holds),
        .start         (start),
        .valid_1       (valid_1),
        .valid         (valid),
        .lasts         (lasts),
        .newest        (newest),
        .oldest        (oldest)
    );

    // ---- The frame whose readings come, and how many have
    reg coming;
    reg [2:0] count; // as many as a frame has, and one too many, are counted
    reg [2:0] length; // of the frame that is whole and not read again yet
    reg whole;
    wire moves = in_valid && advance;
    // ---- What has been read again, on its way out
    reg [4:1] read;
    reg [4:1] ends;
    wire last_read = replays && (replay_place == replay_end);
    reg [2:0] outside; // frames that have left, and were not taken

    always @(posedge clock) begin
        started <= 1'b1;
        coming <= begins || (coming && !(moves && in_last));
        if (moves) begin
            count <= in_last ? 3'd0 : (count == TAXELS) ? count : count + 3'd1;
        end
        if (moves && in_last) begin
            length <= count;
        end
        whole <= (moves && in_last) || (whole && !(start && advance));
        if (advance) begin
            read <= {read[3:1], replays};
            ends <= {ends[3:1], last_read};
        end
        outside <= outside + {2'd0, advance && out_valid && out_last} - {2'd0, take};
        if (reset) begin
            coming <= 1'b0;
            count <= 3'd0;
            whole <= 1'b0;
            read <= 4'd0;
            outside <= 3'd0;
        end
    end

    always @(*) begin
        assume (!begins || (started && advance && !hold));
        assume (!in_valid || coming);
        assume (!take || (outside != 3'd0));
        assume (outside != 3'd6);
    end

    always @(posedge clock) begin
        if (!reset) begin
            // Held from the first beat until its sums are taken; whoever holds is on the way to let go
            assert (hold == (coming || (settles != 2'd0) || pending || holds));
            // A frame is read again once, when it is whole, as far as it goes
            assert (!(start && advance) || (whole && (ends_at == length)));
            assert (!(start && advance) || !replays || last_read);
            assert (!replays || (replay_place <= replay_end));
            assert (!replays || (replay_end <= TAXELS));
            // It leaves as it is read
            assert (out_valid == read[4]);
            assert (!out_valid || (out_last == ends[4]));
            // A frame that is whole waits for nothing but the one that is read
            assert (!pending || replays);
            assert (newest - oldest == outside);
        end
    end

`ifdef INVARIANTS
    always @(posedge clock) begin
        if (!reset) begin
            assert (place == count);
            assert (count <= TAXELS);
            assert (!whole || ((length <= TAXELS) && (ends_at == length)));
            assert (whole == ((settles != 2'd0) || pending));
            assert (coming + settles[1] + settles[2] + pending + holds <= 1);
            assert (coming || (count == 3'd0));
            assert ({valid, valid_1} == read);
            assert ((read & lasts) == (read & ends));
        end
    end
`endif

endmodule
