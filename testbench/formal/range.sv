// SPDX-License-Identifier: MIT OR Apache-2.0
//
// A range of its own for each frame: every frame is written once, whole, element after element into the bank that is its
// turn, with one power of two that is known before and held, while writes wait for others; and nothing comes in meanwhile.
//
// Assumed: stresses come only while no frame is inside, a frame is started only if it waits, and two wait at most.
module harness (
    input wire clock,
    input wire stress_valid,
    input wire signed [26:0] stress,
    input wire frame_done,
    input wire bad_length,
    input wire write_ready,
    input wire frame_start
);

    localparam ELEMENTS = 4;
    localparam STAGES = 5; // from an element's turn to its write

    reg started = 1'b0;
    wire reset = !started;
    wire idle;
    wire write_valid;
    wire write_bank;
    wire [2:0] write_row;
    wire [26:0] write_data;
    wire frame_ready;
    wire scaled;
    wire [4:0] exponent;
    wire [6:1] settles;
    wire busy;
    wire reads;
    wire [5:1] valid;
    wire [5:1] lasts;
    wire [2:0] element;
    wire [1:0] frames_waiting;

    sptfra_range subject (
        .clock            (clock),
        .reset            (reset),
        .stress_valid     (stress_valid),
        .stress           (stress),
        .frame_done       (frame_done),
        .frame_bad_length (bad_length),
        .idle             (idle),
        .write_valid      (write_valid),
        .write_ready      (write_ready),
        .write_bank       (write_bank),
        .write_row        (write_row),
        .write_data       (write_data),
        .frame_ready      (frame_ready),
        .frame_start      (frame_start),
        .scaled           (scaled),
        .exponent         (exponent),
        // Inside
        .settles          (settles),
        .busy             (busy),
        .reads            (reads),
        .valid            (valid),
        .lasts            (lasts),
        .element          (element),
        .frames_waiting   (frames_waiting)
    );

    // ---- The frame inside, what of it is written, and what is known of it
    reg inside;
    reg [2:0] written;
    reg bank;
    reg told;
    reg [1:0] waiting;
    wire writes = write_valid && write_ready;
    wire leaves = writes && (written == ELEMENTS - 1);

    // ---- The cycle before
    reg held;
    reg [30:0] held_write;
    reg known;
    reg [4:0] known_exponent;

    // ---- Turns of elements since the first one's
    reg counting;
    reg [3:0] step;

    always @(posedge clock) begin
        started <= 1'b1;
        inside <= frame_done || (inside && !leaves);
        written <= leaves ? 3'd0 : written + {2'd0, writes};
        bank <= bank ^ leaves;
        told <= (told || scaled) && !leaves;
        waiting <= waiting + {1'b0, leaves} - {1'b0, frame_start};
        held <= write_valid && !write_ready;
        held_write <= {write_bank, write_row, write_data};
        known <= (told || scaled) && !leaves;
        known_exponent <= exponent;
        counting <= settles[4] || (counting && !leaves);
        step <= settles[4] ? 4'd0 : step + {3'd0, counting && write_ready};
        if (reset) begin
            inside <= 1'b0;
            written <= 3'd0;
            bank <= 1'b0;
            told <= 1'b0;
            waiting <= 2'd0;
            held <= 1'b0;
            known <= 1'b0;
            counting <= 1'b0;
        end
    end

    always @(*) begin
        assume (started || !(stress_valid || frame_done || frame_start));
        assume (idle || !(stress_valid || frame_done));
        assume (!frame_start || (waiting != 2'd0));
        assume (!frame_done || (waiting != 2'd2));
    end

    always @(posedge clock) begin
        if (!reset) begin
            assert (idle == !inside);
            // Its elements in their order, into its bank, and none but its own
            assert (!write_valid || inside);
            assert (!write_valid || ((write_row == written) && (write_bank == bank)));
            // What waits to be written stays
            assert (!held || (write_valid && ({write_bank, write_row, write_data} == held_write)));
            // The power of two once, before the first write, and no other until the last one
            assert (!scaled || (inside && !told));
            assert (!write_valid || told);
            assert (!known || (exponent == known_exponent));
            // Ready when it is written, until it is started
            assert (frame_ready == (waiting != 2'd0));
        end
    end

`ifdef INVARIANTS
    always @(posedge clock) begin
        if (!reset) begin
            assert (busy == inside);
            assert (inside == ((settles[4:1] != 4'd0) || counting));
            assert (3'd0 + settles[1] + settles[2] + settles[3] + settles[4] + settles[5] + settles[6] + scaled + told
                == {2'd0, inside});
            assert ((settles[4:1] == 4'd0) || !counting);
            assert (!settles[5] || (counting && (step == 4'd0)));
            assert (!settles[6] || (counting && (step <= 4'd1)));
            assert (!scaled || (counting && (step <= 4'd2)));
            assert (!told || counting);
            assert (!counting || (step <= STAGES + ELEMENTS - 1));
            assert (reads == (counting && (step < ELEMENTS)));
            assert (element == (reads ? step[2:0] : 3'd0));
            assert (written == ((counting && (step > STAGES)) ? step - STAGES : 0));
            assert (write_row == written);
            assert (write_bank == bank);
            assert (frames_waiting == waiting);
            assert (waiting != 2'd3);
            assert ((waiting != 2'd2) || !inside);
        end
    end

    genvar stage;

    generate
        for (stage = 1; stage <= STAGES; stage = stage + 1) begin : gen_stages
            always @(posedge clock) begin
                if (!reset) begin
                    assert (valid[stage] == (counting && (step >= stage) && (step < stage + ELEMENTS)));
                    assert (lasts[stage] == (counting && (step == stage + ELEMENTS - 1)));
                end
            end
        end
    endgenerate
`endif

endmodule
