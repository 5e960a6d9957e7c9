// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Dead taxels and their weights in two calibration banks. Words of a bank from FIRST on:
//
//     1                  count of dead taxels in bits 3:0, fraction bits of the weights in bits 12:8
//     REPLACEABLE        their numbers, ascending; those behind the count mean nothing
//     TAXELS             of REPLACEABLE weights each, two's complement
//
// Words that are out of bounds are not written. A commit checks what depends on several words. Numbers ascend, a dead
// taxel has no weight in any sum, and no sum of weights exceeds its accumulator.
//
// Latency from command to word and from read_taxel to its weights: 1 cycle. Interval: 1 cycle.

`default_nettype none

module sptfra_dead_bank #(
    // Taxels of a frame
    parameter TAXELS = 12,
    // Places of the map: 1, 2, 4 or 8
    parameter REPLACEABLE = 2,
    // Word of a bank with which this part of it begins
    parameter [15:0] FIRST = 16'd26,
    // At power-up: dead taxels, fraction bits of the weights, numbers; the weights stand in files, one for each place
    parameter [3:0] COUNT = 4'd0,
    parameter [4:0] WEIGHT_SHIFT = 5'd17,
    parameter [16*REPLACEABLE-1:0] NUMBERS = {16*REPLACEABLE{1'b0}},
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    // {copy, take, write and end of a tare's copy, begin and word of a walk, write, bank, word of a bank, data}
    input  wire [55:0] command,
    output wire [33:0] result, // {contradicts itself, data may be written, word: a cycle after its place}
    // Of the active bank, and of the frame that comes in
    input  wire active,
    output wire [3:0] active_count,
    input  wire read_bank,
    input  wire [TAXEL_WIDTH-1:0] read_taxel,
    output wire [18*REPLACEABLE-1:0] read_weights,
    output wire [3:0] read_count,
    output wire [4:0] read_shift,
    output wire [16*REPLACEABLE-1:0] read_numbers
);

    localparam SLOT_BITS = $clog2(REPLACEABLE);
    localparam [31:0] PLACES_WIDE = REPLACEABLE;
    localparam [15:0] PLACES = PLACES_WIDE[15:0];
    localparam [31:0] LAST_PLACE = REPLACEABLE - 1;
    localparam [31:0] TAXELS_WIDE = TAXELS;
    localparam [15:0] TAXELS_HERE = TAXELS_WIDE[15:0];
    localparam signed [31:0] MOST_WEIGHT = 32'sd131071;
    localparam [21:0] MOST_SUM = 22'd2097151; // of a sum's weights, for an accumulator of 48 bits
    localparam [4:0] MOST_SHIFT = 5'd17;
    localparam HEAD_BITS = 16 * REPLACEABLE + 9; // numbers, shift, count
    localparam [HEAD_BITS-1:0] HEAD = {NUMBERS, WEIGHT_SHIFT, COUNT};

    wire copies;
    wire copy_takes;
    wire copy_writes;
    wire copy_ends;
    wire walk_begins;
    wire walk_takes;
    wire write;
    wire bank;
    wire [15:0] position;
    wire [31:0] data;

    assign {copies, copy_takes, copy_writes, copy_ends, walk_begins, walk_takes, write, bank, position, data} = command;

    // ---- The word: its place, then its content
    reg [HEAD_BITS-1:0] head_0;
    reg [HEAD_BITS-1:0] head_1;
    wire [HEAD_BITS-1:0] head = bank ? head_1 : head_0;
    wire [16*REPLACEABLE-1:0] numbers = head[HEAD_BITS-1:9];
    wire [15:0] place = position - FIRST;
    wire [15:0] behind_count = place - 16'd1;
    wire [15:0] behind_numbers = place - 16'd1 - PLACES;
    wire of_count = (place == 16'd0);
    wire of_number = !of_count && (place <= PLACES);
    wire of_weight = !of_count && !of_number;
    wire [2:0] slot = (of_number ? behind_count[2:0] : behind_numbers[2:0]) & LAST_PLACE[2:0];
    wire [15:0] taxel = copies ? position : behind_numbers >> SLOT_BITS;
    wire [18*REPLACEABLE-1:0] weights;
    reg [2:0] slot_1;
    reg [15:0] head_word_1;
    reg of_weight_1;
    wire signed [17:0] weight = weights[18*slot_1 +: 18];
    wire [31:0] word = of_weight_1 ? {{14{weight[17]}}, weight} : {16'd0, head_word_1};

    always @(posedge clock) begin
        slot_1 <= slot;
        of_weight_1 <= of_weight;
        head_word_1 <= of_count ? {3'd0, head[8:4], 4'd0, head[3:0]} : numbers[16*slot +: 16];
    end

    // ---- Writes
    wire count_fits = (data[31:13] == 19'd0) && (data[7:4] == 4'd0) && ({12'd0, data[3:0]} <= PLACES)
        && (data[12:8] <= MOST_SHIFT);
    wire number_fits = (data[31:16] == 16'd0) && (data[15:0] < TAXELS_HERE);
    wire weight_fits = ($signed(data) <= MOST_WEIGHT) && ($signed(data) >= -MOST_WEIGHT) && (taxel < TAXELS_HERE);
    wire allowed = (of_count && count_fits) || (of_number && number_fits) || (of_weight && weight_fits);
    wire writes = write && allowed;
    reg [18*REPLACEABLE-1:0] copied;
    reg [HEAD_BITS-1:0] written; // head of the bank that is written
    genvar index;

    // Configuration, no reset, brings the design's content
    initial begin
        head_0 = HEAD;
        head_1 = HEAD;
    end

    always @(*) begin
        written = head;
        if (writes && of_count) begin
            written[8:0] = {data[12:8], data[3:0]};
        end
        if (writes && of_number) begin
            written[16*slot + 9 +: 16] = data[15:0];
        end
        if (copy_ends) begin
            written = bank ? head_0 : head_1;
        end
    end

    always @(posedge clock) begin
        if (writes || copy_ends) begin
            if (bank) begin
                head_1 <= written;
            end else begin
                head_0 <= written;
            end
        end
        if (copy_takes) begin
            copied <= weights;
        end
    end

    localparam [63:0] DIGITS = "76543210"; // 0 in the lowest bits

    for (index = 0; index < REPLACEABLE; index = index + 1) begin : gen_places
        localparam [31:0] PLACE = index;

        sptfra_bank #(
            .WIDTH         (18),
            .ADDRESS_WIDTH (TAXEL_WIDTH + 1),
            .ROM_DIR       (ROM_DIR),
            .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_weights", DIGITS[8*index +: 8], ".mem"})
        ) of_place (
            .clock        (clock),
            .write_enable (copy_writes || (writes && of_weight && (slot == PLACE[2:0]))),
            .address      ({bank, taxel[TAXEL_WIDTH-1:0]}),
            .write_data   (copies ? copied[18*index +: 18] : data[17:0]),
            .data         (weights[18*index +: 18]),
            .read_address ({read_bank, read_taxel}),
            .read_data    (read_weights[18*index +: 18])
        );
    end

    // ---- The walk of a commit: a word is there when it is taken
    reg contradicts;
    reg [15:0] number_before;
    reg [22*REPLACEABLE-1:0] magnitudes; // sums of the places' weights, that of the next word lowest
    wire [17:0] magnitude = weight[17] ? -weight : weight;
    wire [21:0] magnitude_sum = magnitudes[21:0] + {4'd0, magnitude};
    wire [REPLACEABLE-1:0] is_this;
    reg is_dead_1;

    for (index = 0; index < REPLACEABLE; index = index + 1) begin : gen_walk
        localparam [31:0] PLACE = index;

        assign is_this[index] = (PLACE[3:0] < head[3:0]) && (numbers[16*index +: 16] == taxel);

        always @(posedge clock) begin
            if (walk_begins) begin
                magnitudes[22*index +: 22] <= 22'd0;
            end else if (walk_takes && of_weight) begin
                magnitudes[22*index +: 22] <= (index == REPLACEABLE - 1) ? magnitude_sum
                    : magnitudes[22*((index + 1) % REPLACEABLE) +: 22];
            end
        end
    end

    always @(posedge clock) begin
        is_dead_1 <= (is_this != {REPLACEABLE{1'b0}});
        if (walk_takes && of_number) begin
            number_before <= head_word_1;
            contradicts <= contradicts
                || ((slot != 3'd0) && ({1'b0, slot} < head[3:0]) && (head_word_1 <= number_before));
        end
        if (walk_takes && of_weight) begin
            contradicts <= contradicts || (magnitude_sum > MOST_SUM) || (is_dead_1 && (weight != 18'sd0));
        end
        if (walk_begins) begin
            contradicts <= 1'b0;
        end
    end

    // ---- Frames
    wire [HEAD_BITS-1:0] read_head = read_bank ? head_1 : head_0;

    assign result = {contradicts, allowed, word};
    assign active_count = active ? head_1[3:0] : head_0[3:0];
    assign {read_numbers, read_shift, read_count} = read_head;

    wire _unused = &{1'b0, behind_count[15:3], taxel, LAST_PLACE};

endmodule

`default_nettype wire
