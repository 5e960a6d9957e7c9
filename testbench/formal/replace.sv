// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Replacing dead taxels: a frame is read again whole and once, from its first reading to its last, without what was
// beyond its last taxel, and `busy` says so until it has left.
//
// Assumed: readings come only while no frame is inside, and the first one is of the frame.
module harness (
    input wire clock,
    input wire in_takes,
    input wire in_ends
);

    localparam TAXELS = 4;

    reg started = 1'b0;
    wire reset = !started;
    wire busy;
    wire out_valid;
    wire out_last;
    wire [1:0] place;
    wire [1:0] end_place;
    wire [2:1] settles;
    wire replays;
    wire holds;
    wire valid_1;
    wire [4:2] valid;
    wire [4:1] lasts;

    sptfra_replace subject (
        .clock     (clock),
        .reset     (reset),
        .in_takes  (in_takes),
        .in_ends   (in_ends),
        .busy      (busy),
        .out_valid (out_valid),
        .out_last  (out_last),
        // Inside
        .place     (place),
        .end_place (end_place),
        .settles   (settles),
        .replays   (replays),
        .holds     (holds),
        .valid_1   (valid_1),
        .valid     (valid),
        .lasts     (lasts)
    );

    // ---- Readings of the frame that comes, of the one that is whole, and of those that have gone out
    reg [2:0] count;
    reg [2:0] length;
    reg [2:0] out;
    reg whole;
    wire [2:0] counted = count + {2'd0, in_takes};

    always @(posedge clock) begin
        started <= 1'b1;
        count <= in_ends ? 3'd0 : counted;
        if (in_ends) begin
            length <= counted;
            whole <= 1'b1;
        end
        if (out_valid) begin
            out <= out + 3'd1;
        end
        if (out_valid && out_last) begin
            whole <= 1'b0;
            out <= 3'd0;
        end
        if (reset) begin
            count <= 3'd0;
            whole <= 1'b0;
            out <= 3'd0;
        end
    end

    always @(*) begin
        assume (!(in_takes || in_ends) || !whole);
        assume (!in_takes || (count != TAXELS));
        assume (!in_ends || (counted != 3'd0));
    end

    always @(posedge clock) begin
        if (!reset) begin
            assert (busy == whole);
            // As many readings leave as came, and the last one says so
            assert (!out_valid || (whole && (out < length)));
            assert (!out_valid || (out_last == (out + 3'd1 == length)));
            // Reading again begins when the last product is in its sum
            assert (!replays || (settles == 2'd0));
            assert (!holds || (replays && (place == 2'd0)));
        end
    end

`ifdef INVARIANTS
    wire [4:1] read = {valid, valid_1};
    // Readings that have been read again
    wire [2:0] again = out + read[1] + read[2] + read[3] + read[4];
    wire [2:0] at_3 = out + read[4];
    wire [2:0] at_2 = at_3 + read[3];
    wire [2:0] at_1 = at_2 + read[2];

    always @(posedge clock) begin
        if (!reset) begin
            assert (count <= TAXELS);
            assert (whole || ({1'b0, place} == count) || ((count == TAXELS) && (place == 2'd0)));
            assert (whole || (count == 3'd0) || ({1'b0, end_place} + 3'd1 == count));
            assert (!whole || (count == 3'd0));
            assert (!whole || ((length != 3'd0) && (length <= TAXELS) && ({1'b0, end_place} + 3'd1 == length)));
            assert (whole || ((settles == 2'd0) && !replays && !holds && (read == 4'd0) && (out == 3'd0)));
            assert (!whole || (out < length));
            assert (settles != 2'd3);
            assert ((settles == 2'd0) || (!replays && (read == 4'd0) && (out == 3'd0) && (place == 2'd0)));
            assert (!replays || (({1'b0, place} == again) && (again < length)));
            assert (!whole || replays || (settles != 2'd0) || ((again == length) && (place == 2'd0)));
            assert (!read[4] || (lasts[4] == (out + 3'd1 == length)));
            assert (!read[3] || (lasts[3] == (at_3 + 3'd1 == length)));
            assert (!read[2] || (lasts[2] == (at_2 + 3'd1 == length)));
            assert (!read[1] || (lasts[1] == (at_1 + 3'd1 == length)));
        end
    end
`endif

endmodule
