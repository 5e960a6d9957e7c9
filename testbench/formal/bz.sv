// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The frame checker (Bz): every beat once and in order, every frame ended once and rightly judged, banks never overrun.
//
// A second pipeline beside it carries each beat with its place in its frame. With PAPER it is that of the paper's plan,
// which writes each stress without a fold.
module harness (
    input wire clock,
    input wire [31:0] s_tdata,
    input wire s_tlast,
    input wire s_tvalid,
    input wire write_ready, // of the operand memories
    input wire cean_idle,
    input wire direction_room,
    input wire frame_start,
    input wire frame_release
);

    localparam [4:0] TAXELS = 5'd12, MANY = 5'd31;
`ifdef PAPER
    localparam ROW_BITS = 4;
    localparam [3:0] ELEMENTS = 4'd12;
`else
    localparam ROW_BITS = 3;
    localparam [3:0] ELEMENTS = 4'd4;
`endif

    reg started = 1'b0;
    wire reset = !started;
    wire s_tready;
    wire write_valid;
    wire write_bank;
    wire [ROW_BITS-1:0] write_row;
    wire stress_valid;
    wire signed [26:0] stress;
    wire frame_done;
    wire frame_saturated;
    wire frame_not_finite;
    wire frame_bad_length;
    wire frame_ready;
    wire in_frame;
    wire may_open;
    wire [3:0] index;
    wire [1:0] banks_taken;
    wire [1:0] frames_waiting;
    wire [5:1] valid;
    wire [5:1] stores;
    wire [5:1] lasts;
    wire [5:1] bad_lengths;
    wire seen_saturated;
    wire seen_not_finite;
    wire [14:0] stages;
    wire ended;
    wire flags_sent;
    wire folded;
    wire [ROW_BITS-1:0] orbit;
    wire [4:1] fold_valid;
    wire [4:1] fold_lasts;
    wire [4*ROW_BITS-1:0] fold_rows;
    wire fold_read;
    wire frame_written;

    sptfra_bz subject (
        .clock            (clock),
        .reset            (reset),
        .s_tdata          (s_tdata),
        .s_tlast          (s_tlast),
        .s_tvalid         (s_tvalid),
        .s_tready         (s_tready),
        .write_valid      (write_valid),
        .write_ready      (write_ready),
        .write_bank       (write_bank),
        .write_row        (write_row),
        .direction_room   (direction_room),
        .cean_idle        (cean_idle),
        .stress_valid     (stress_valid),
        .stress           (stress),
        .frame_done       (frame_done),
        .frame_saturated  (frame_saturated),
        .frame_not_finite (frame_not_finite),
        .frame_bad_length (frame_bad_length),
        .frame_ready      (frame_ready),
        .frame_start      (frame_start),
        .frame_release    (frame_release),
        // Inside
        .in_frame         (in_frame),
        .\gate.may_open (may_open),
        .\gate.index (index),
        .\writer.banks_taken (banks_taken),
        .\writer.frames_waiting (frames_waiting),
        .\gate.valid (valid),
        .\gate.stores (stores),
        .\gate.lasts (lasts),
        .\gate.bad_lengths (bad_lengths),
        .\writer.seen_saturated (seen_saturated),
        .\writer.seen_not_finite (seen_not_finite),
        .\writer.frame_written (frame_written),
        .\writer.ended (ended),
        .\writer.flags_sent (flags_sent),
        .\writer.fold.done (folded),
        .\writer.fold.read (fold_read),
        .\writer.fold.orbit (orbit),
        .\writer.fold.valid (fold_valid),
        .\writer.fold.lasts (fold_lasts),
        .\writer.fold.rows (fold_rows),
        .\gen_samples[0].samples.gen_float.float_to_fixed.stages (stages)
    );

    // ---- Elements in the order in which they are written
    function [ROW_BITS-1:0] row_of(input [3:0] place);
`ifdef PAPER
        row_of = place;
`else
        row_of = 3'd3 - place[2:0];
`endif
    endfunction

    function [3:0] after(input [3:0] place);
        after = (place == ELEMENTS - 4'd1) ? 4'd0 : place + 4'd1;
    endfunction

    // ---- Each beat with its place in its frame; a place of 31 is that or more
    function [4:0] following(input [4:0] place, input last);
        following = last ? 5'd0 : (place == MANY) ? MANY : place + 5'd1;
    endfunction

    wire taken = s_tvalid && s_tready;
    reg [4:0] place_in;
    reg [4:0] place_out; // of the next beat to come out
    reg [5:1] there;
    reg [24:0] places;
    reg [5:1] ends;
    reg [14:0] words;
    reg any_saturated; // of the beats of the frame that have come out
    reg any_not_finite;
    wire comes_out = there[5];
    wire counts = comes_out && (places[24:20] < TAXELS);

    always @(posedge clock) begin
        started <= 1'b1;
        if (taken) begin
            place_in <= following(place_in, s_tlast);
        end
        there <= {there[4:1], taken};
        places <= {places[19:0], place_in};
        ends <= {ends[4:1], s_tlast};
        words <= {words[11:0], s_tdata[2:0]};
        if (comes_out) begin
            place_out <= following(place_out, ends[5]);
            any_saturated <= !ends[5] && (any_saturated || (counts && words[13]));
            any_not_finite <= !ends[5] && (any_not_finite || (counts && words[14]));
        end
        if (reset) begin
            place_in <= 5'd0;
            place_out <= 5'd0;
            there <= 5'd0;
            any_saturated <= 1'b0;
            any_not_finite <= 1'b0;
        end
    end

    // ---- Frames from their first beat to their release
    reg [2:0] frames_inside;
    reg [2:0] frames_in_work;

    always @(posedge clock) begin
        frames_inside <= frames_inside + {2'd0, taken && (place_in == 5'd0)} - {2'd0, frame_release};
        frames_in_work <= frames_in_work + {2'd0, frame_start} - {2'd0, frame_release};
        if (reset) begin
            frames_inside <= 3'd0;
            frames_in_work <= 3'd0;
        end
    end

    // The lanes take a frame that is there, and release one that they have
    always @(*) begin
        assume (!frame_start || frame_ready);
        assume (!frame_release || (frames_in_work != 3'd0));
    end

    reg waited = 1'b0;
    wire [ROW_BITS:0] to_write = {write_bank, write_row};
    reg [ROW_BITS:0] waiting;
    wire writes = write_valid && write_ready;
    reg bank_out; // of the frame that is written
    reg [3:0] element; // of it that is written next
    reg [3:0] elements_read; // elements of the frame inside that were read
    reg kept; // a whole frame is inside
    reg nothing_missing; // for a new frame, a cycle ago
    wire last_element = (element == ELEMENTS - 4'd1);

    always @(posedge clock) begin
        waited <= write_valid && !write_ready && !reset;
        waiting <= to_write;
        nothing_missing <= !taken && cean_idle && direction_room && (frames_inside != 3'd2) && (there == 5'd0) && !kept;
        bank_out <= bank_out ^ (writes && last_element);
        element <= !writes ? element : last_element ? 4'd0 : element + 4'd1;
        elements_read <= (kept && (elements_read == ELEMENTS)) ? 4'd0 : elements_read + {3'd0, fold_read};
        kept <= frame_done || (kept && (elements_read != ELEMENTS));
        if (reset) begin
            nothing_missing <= 1'b1;
            bank_out <= 1'b0;
            element <= 4'd0;
            elements_read <= 4'd0;
            kept <= 1'b0;
        end
    end

    always @(posedge clock) begin
        if (!reset) begin
            // Every beat of a frame's first twelve comes out, once, in order, as it came in
            assert (stress_valid == counts);
            assert (!stress_valid || (stress[0] == words[12]));
            assert (!comes_out || (places[24:20] == place_out));
            // Every frame ends once, and its flags are those of its beats
            assert (frame_done == (comes_out && ends[5]));
            assert (!frame_done || (frame_bad_length == (places[24:20] != TAXELS - 5'd1)));
            assert (!frame_done || (frame_saturated == (any_saturated || (counts && words[13]))));
            assert (!frame_done || (frame_not_finite == (any_not_finite || (counts && words[14]))));
            // Two banks: never more than two frames between the first beat and the release
            assert (frames_inside <= 3'd2);
            assert (!frame_written || (frames_waiting != 2'd2));
            // What is to be written stays until it is
            assert (!waited || (write_valid && (to_write == waiting)));
            // Each element once, in order, into its frame's bank; the frame is written with its last one
            assert (!write_valid || ((write_bank == bank_out) && (write_row == row_of(element))));
            assert (frame_written == (writes && last_element));
            // Whoever waits is served: nothing stands still but for want of a bank, of CeAn or of the memories' port
            assert (s_tready || (!in_frame && !nothing_missing));
            assert (!kept || (elements_read == ELEMENTS) || (fold_read == write_ready));
        end
    end

`ifdef INVARIANTS
    wire [4:0] next_4 = there[5] ? following(place_out, ends[5]) : place_out;
    wire [4:0] next_3 = there[4] ? following(next_4, ends[4]) : next_4;
    wire [4:0] next_2 = there[3] ? following(next_3, ends[3]) : next_3;
    wire [4:0] next_1 = there[2] ? following(next_2, ends[2]) : next_2;
    wire [4:0] next_0 = there[1] ? following(next_1, ends[1]) : next_1;
    wire [5:1] frames = there & ends;
    // Elements on their way to be written
    wire [3:0] row_3 = fold_valid[4] ? after(element) : element;
    wire [3:0] row_2 = fold_valid[3] ? after(row_3) : row_3;
    wire [3:0] row_1 = fold_valid[2] ? after(row_2) : row_2;
    wire [3:0] row_0 = fold_valid[1] ? after(row_1) : row_1;
    wire [15:0] rows_there = {element, row_3, row_2, row_1};
    integer stage;
    integer before;

    always @(posedge clock) begin
        if (!reset) begin
            assert (valid == there);
            assert (write_bank == bank_out);
            assert (element < ELEMENTS);
            assert (elements_read <= ELEMENTS);
            assert (ended == kept);
            assert (flags_sent == ended);
            assert (folded == (elements_read == ELEMENTS));
            assert (folded || (orbit == ELEMENTS[ROW_BITS-1:0] - 1'b1 - elements_read[ROW_BITS-1:0]));
            assert (!folded || kept);
            assert (((elements_read == ELEMENTS) ? 4'd0 : elements_read) == row_0);
            assert (!kept || (there == 5'd0));
            assert (!kept || !in_frame);
            assert (!may_open || ((there == 5'd0) && !kept));
            for (stage = 1; stage <= 5; stage = stage + 1) begin
                if (frames[stage]) begin
                    assert (!in_frame);
                    assert (!may_open);
                    for (before = 1; before < stage; before = before + 1) begin
                        assert (!there[before]);
                    end
                end
            end
            for (stage = 1; stage <= 4; stage = stage + 1) begin
                if (fold_valid[stage]) begin
                    assert (fold_rows[ROW_BITS*stage-1 -: ROW_BITS] == row_of(rows_there[4*stage-1 -: 4]));
                end
                assert (fold_lasts[stage]
                    == (fold_valid[stage] && (rows_there[4*stage-1 -: 4] == ELEMENTS - 4'd1)));
            end
            assert (in_frame == (place_in != 5'd0));
            assert ({1'b0, index} == ((place_in > TAXELS) ? TAXELS : place_in));
            for (stage = 1; stage <= 5; stage = stage + 1) begin
                if (there[stage]) begin
                    assert (stages[3*stage-3 +: 3] == words[3*stage-3 +: 3]);
                    assert (lasts[stage] == ends[stage]);
                    assert (stores[stage] == (places[5*stage-5 +: 5] < TAXELS));
                    assert (bad_lengths[stage] == (places[5*stage-5 +: 5] != TAXELS - 5'd1));
                end
            end
            assert (!there[5] || (places[20 +: 5] == place_out));
            assert (!there[4] || (places[15 +: 5] == next_4));
            assert (!there[3] || (places[10 +: 5] == next_3));
            assert (!there[2] || (places[5 +: 5] == next_2));
            assert (!there[1] || (places[0 +: 5] == next_1));
            assert (place_in == next_0);
            assert (seen_saturated == any_saturated);
            assert (seen_not_finite == any_not_finite);
            assert (frames_inside == {1'b0, banks_taken});
            assert (may_open == nothing_missing);
            assert (!may_open || (banks_taken != 2'd2));
            assert ({2'd0, frames_inside} == {4'd0, in_frame} + frames[1] + frames[2] + frames[3] + frames[4]
                + frames[5] + (ended && !folded) + fold_lasts[1] + fold_lasts[2] + fold_lasts[3] + fold_lasts[4]
                + {1'b0, frames_waiting} + frames_in_work);
        end
    end
`endif

endmodule
